/* The stand-in for PX4 in the tests. SPDX-License-Identifier: MIT */
#include "standin.hpp"

#include <px4_platform_common/param.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <uORB/topics/parameter_update.h>
#include <utility>
#include <vector>

namespace standin {

namespace {

struct Node {
    unsigned generation{0};
    std::vector<std::vector<unsigned char>> message; /* ring of the queue's length */
    std::vector<Scheduled *> callbacks;
};

struct Timer {
    Scheduled *item;
    uint32_t every_us;
    uint64_t due_us;
};

constexpr size_t TEXT = 512;
constexpr int RUNS_MAX = 100000; /* at one time; more is an endless loop */

uint64_t clock_us;
std::map<std::pair<std::string, int>, Node> nodes;
std::vector<Timer> timers;
std::vector<Scheduled *> ready;
std::map<int, uint32_t> values; /* bits of each parameter that was set */
std::vector<bool> used;
std::vector<std::pair<std::string, float>> others; /* parameters of other modules */
std::string console_text, ground_text;

Node &node_of(orb_id_t topic, uint8_t instance) {
    Node &node = nodes[{topic->o_name, instance}];
    node.message.resize(topic->o_queue);
    return node;
}

void append(std::string &to, const char *format, va_list arguments) {
    char text[TEXT];
    vsnprintf(text, sizeof text, format, arguments);
    to += text;
}

int index_of(const char *parameter) {
    for (int i = 0; i < px4::standin_parameters; i++) {
        if (strcmp(px4::standin_parameter[i].name, parameter) == 0) {
            return i;
        }
    }
    fprintf(stderr, "no parameter %s\n", parameter);
    abort();
}

void set_bits(const char *parameter, const void *value) {
    parameter_update_s update{};
    memcpy(&values[index_of(parameter)], value, sizeof(uint32_t));
    update.timestamp = clock_us;
    publish(ORB_ID(parameter_update), &update);
}

} // namespace

void begin(uint64_t start_us) {
    clock_us = start_us;
    nodes.clear();
    timers.clear();
    ready.clear();
    values.clear();
    others.clear();
    used.assign(static_cast<size_t>(px4::standin_parameters), false);
    console_text.clear();
    ground_text.clear();
}

uint64_t now_us() { return clock_us; }

void set_clock(uint64_t us) {
    for (Timer &timer : timers) {
        timer.due_us = us + (timer.due_us > clock_us ? timer.due_us - clock_us : 0);
    }
    clock_us = us;
}

void settle() {
    for (int i = 0; !ready.empty(); i++) {
        Scheduled *const item = ready.front();
        ready.erase(ready.begin());
        item->run_item();
        if (i > RUNS_MAX) {
            abort();
        }
    }
}

void advance(uint64_t us) {
    const uint64_t end_us = clock_us + us;
    settle();
    for (;;) {
        const auto next = std::min_element(timers.begin(), timers.end(),
                                           [](const Timer &a, const Timer &b) { return a.due_us < b.due_us; });
        if (next == timers.end() || next->due_us > end_us) {
            break;
        }
        clock_us = next->due_us;
        next->due_us += next->every_us;
        next->item->schedule();
        settle();
    }
    clock_us = end_us;
}

/* ----------------------------------------------------------------------------------------------------------- topics -- */

void publish(orb_id_t topic, const void *data, uint8_t instance) {
    Node &node = node_of(topic, instance);
    std::vector<unsigned char> &place = node.message[node.generation % topic->o_queue];
    place.resize(topic->o_size);
    memcpy(place.data(), data, topic->o_size);
    node.generation++;
    for (Scheduled *item : std::vector<Scheduled *>(node.callbacks)) {
        item->schedule();
    }
}

unsigned published(orb_id_t topic, uint8_t instance) { return node_of(topic, instance).generation; }

unsigned first_generation(orb_id_t topic, uint8_t instance) {
    const unsigned generation = published(topic, instance);
    return generation > 0 ? generation - 1 : 0;
}

bool copy(orb_id_t topic, uint8_t instance, unsigned &generation, void *data) {
    Node &node = node_of(topic, instance);
    if (generation >= node.generation) {
        return false;
    }
    generation = std::max(generation, node.generation > topic->o_queue ? node.generation - topic->o_queue : 0u);
    memcpy(data, node.message[generation % topic->o_queue].data(), topic->o_size);
    generation++;
    return true;
}

bool latest(orb_id_t topic, uint8_t instance, void *data) {
    unsigned generation = first_generation(topic, instance);
    return copy(topic, instance, generation, data);
}

void on_publish(orb_id_t topic, uint8_t instance, Scheduled *item) {
    node_of(topic, instance).callbacks.push_back(item);
}

void off_publish(orb_id_t topic, uint8_t instance, Scheduled *item) {
    std::vector<Scheduled *> &callbacks = node_of(topic, instance).callbacks;
    callbacks.erase(std::remove(callbacks.begin(), callbacks.end(), item), callbacks.end());
}

/* ------------------------------------------------------------------------------------------------------- work items -- */

Scheduled::~Scheduled() {
    schedule_clear();
    for (auto &entry : nodes) {
        std::vector<Scheduled *> &callbacks = entry.second.callbacks;
        callbacks.erase(std::remove(callbacks.begin(), callbacks.end(), this), callbacks.end());
    }
}

void Scheduled::schedule() {
    if (std::find(ready.begin(), ready.end(), this) == ready.end()) {
        ready.push_back(this);
    }
}

void Scheduled::schedule_every(uint32_t us) { timers.push_back({this, us, clock_us + us}); }

void Scheduled::schedule_clear() {
    ready.erase(std::remove(ready.begin(), ready.end(), this), ready.end());
    timers.erase(
        std::remove_if(timers.begin(), timers.end(), [this](const Timer &timer) { return timer.item == this; }),
        timers.end());
}

/* ------------------------------------------------------------------------------------------------------- parameters -- */

void set(const char *parameter, float value) { set_bits(parameter, &value); }
void set(const char *parameter, int32_t value) { set_bits(parameter, &value); }

void set_other(const char *parameter, float value) {
    parameter_update_s update{};
    const auto known = std::find_if(others.begin(), others.end(),
                                    [=](const std::pair<std::string, float> &p) { return p.first == parameter; });
    if (known != others.end()) {
        known->second = value;
    } else {
        others.emplace_back(parameter, value);
    }
    update.timestamp = clock_us;
    publish(ORB_ID(parameter_update), &update);
}

bool is_used(const char *parameter) { return used[static_cast<size_t>(index_of(parameter))]; }

/* ---------------------------------------------------------------------------------------------------------- console -- */

std::string &console() { return console_text; }
std::string &mavlink_texts() { return ground_text; }

void print(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    append(console_text, format, arguments);
    va_end(arguments);
}

void mavlink_text(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    append(ground_text, format, arguments);
    ground_text += '\n';
    va_end(arguments);
}

} // namespace standin

void param_set_used(param_t parameter) { standin::used[parameter] = true; }

template <typename T> static int get(param_t parameter, bool is_int, T *value) {
    const auto set = standin::values.find(parameter);
    const auto &known = px4::standin_parameter[parameter];
    if (known.is_int != is_int) {
        fprintf(stderr, "%s is of another type\n", known.name);
        abort();
    }
    *value = static_cast<T>(known.standard);
    if (set != standin::values.end()) {
        memcpy(value, &set->second, sizeof set->second);
    }
    return 0;
}

param_t param_find(const char *name) {
    for (size_t i = 0; i < standin::others.size(); i++) {
        if (standin::others[i].first == name) {
            return static_cast<param_t>(static_cast<size_t>(px4::standin_parameters) + i);
        }
    }
    return PARAM_INVALID;
}

int param_get(param_t parameter, float *value) {
    if (parameter < px4::standin_parameters) {
        return get(parameter, false, value);
    }
    *value = standin::others.at(parameter - static_cast<size_t>(px4::standin_parameters)).second;
    return 0;
}
int param_get(param_t parameter, int32_t *value) { return get(parameter, true, value); }
