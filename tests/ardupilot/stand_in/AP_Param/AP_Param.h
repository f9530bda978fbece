/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <cstddef>
#include <cstdint>

enum ap_var_type { AP_PARAM_NONE, AP_PARAM_INT8, AP_PARAM_INT16, AP_PARAM_INT32, AP_PARAM_FLOAT };

template <typename T, ap_var_type PT> class AP_ParamT {
  public:
    static const ap_var_type vtype = PT;
    const T &get() const { return _value; }
    void set(T value) { _value = value; }
    operator const T &() const { return _value; }

  private:
    T _value;
};

typedef AP_ParamT<float, AP_PARAM_FLOAT> AP_Float;
typedef AP_ParamT<int8_t, AP_PARAM_INT8> AP_Int8;
typedef AP_ParamT<int16_t, AP_PARAM_INT16> AP_Int16;

class AP_Param {
  public:
    struct GroupInfo {
        const char *name;
        ptrdiff_t offset;
        float def_value;
        uint16_t flags;
        uint8_t idx;
        uint8_t type;
    };

    static AP_Param *find(const char *name, enum ap_var_type *type, uint16_t *flags = nullptr);
    float cast_to_float(enum ap_var_type type) const;
    static void setup_object_defaults(void *object, const GroupInfo *info);
};

#define AP_PARAM_FLAG_ENABLE (1 << 2)
#define AP_GROUPINFO_FLAGS(name, index, object, element, value, flags)                                                 \
    {name, ptrdiff_t(offsetof(object, element)), value, flags, index, decltype(object::element)::vtype}
#define AP_GROUPINFO(name, index, object, element, value) AP_GROUPINFO_FLAGS(name, index, object, element, value, 0)
#define AP_GROUPEND {"", 0, 0.0f, 0, 0xFF, AP_PARAM_NONE}
