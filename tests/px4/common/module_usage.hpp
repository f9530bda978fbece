/* Common base of both forms of ModuleBase: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include <cstring>
#include <px4_platform_common/log.h>

#define PRINT_MODULE_DESCRIPTION(text) standin::print("%s\n", text)
#define PRINT_MODULE_USAGE_NAME(name, category) standin::print("%s (%s)\n", name, category)
#define PRINT_MODULE_USAGE_COMMAND(name) standin::print("  %s\n", name)
#define PRINT_MODULE_USAGE_DEFAULT_COMMANDS() standin::print("  stop\n  status\n")

namespace standin {

constexpr uint64_t STOP_STEP_US = 10000;
constexpr int STOP_STEPS_MAX = 500;

template <typename T> class Atomic {
  public:
    T load() const { return _value; }
    void store(T value) { _value = value; }

  private:
    T _value{};
};

} // namespace standin
