/* What stands in for PX4 in the tests: a broker of topics, a work queue, a clock, parameters and a console that the tests drive.
 * SPDX-License-Identifier: MIT
 *
 * Written for this project; it has only the names that port/px4 uses. They were compared with PX4 main of 2 March 2026 (tree_2026)
 * and of 20 December 2024, after 1.15 (tree_2024: the older form of ModuleBase, C++14); detect_and_avoid with the message's page
 * of August 2026, the landing's two topics with main of 13 February 2025. What it keeps of PX4's behaviour: a subscriber reads each message of a queue once, the oldest that is left first,
 * and finds the latest one that was published before it came; a callback schedules the work item; nothing runs at once. */
#pragma once

#include <cstdint>
#include <string>

struct orb_metadata {
    const char *o_name;
    uint16_t o_size;
    uint8_t o_queue;
};
using orb_id_t = const orb_metadata *;
using orb_advert_t = void *;
using hrt_abstime = uint64_t;

namespace standin {

class Scheduled;

/* Forgets all topics, parameters, texts and what is scheduled; the clock begins at start_us. */
void begin(uint64_t start_us);

uint64_t now_us();
void set_clock(uint64_t us); /* jumps: timers keep what is left of their interval */
void advance(uint64_t us);   /* the clock moves on, and what is due or scheduled runs */
void settle();               /* what is scheduled runs */

/* Topics. */
void publish(orb_id_t topic, const void *data, uint8_t instance = 0);
unsigned published(orb_id_t topic, uint8_t instance = 0);
bool copy(orb_id_t topic, uint8_t instance, unsigned &generation, void *data); /* false: nothing newer */
bool latest(orb_id_t topic, uint8_t instance, void *data);
unsigned first_generation(orb_id_t topic, uint8_t instance);
void on_publish(orb_id_t topic, uint8_t instance, Scheduled *item);
void off_publish(orb_id_t topic, uint8_t instance, Scheduled *item);

/* A work item. */
class Scheduled {
  public:
    virtual ~Scheduled();
    virtual void run_item() = 0;
    void schedule();
    void schedule_every(uint32_t us);
    void schedule_clear();
};

/* Parameters of module.yaml, by name; set() tells parameter_update. */
void set(const char *parameter, float value);
void set(const char *parameter, int32_t value);
void set_other(const char *parameter, float value); /* of another module: there is none before */
bool is_used(const char *parameter);

/* What was printed, and what was sent to ground stations. */
std::string &console();
std::string &mavlink_texts();
void print(const char *format, ...) __attribute__((format(printf, 1, 2)));
void mavlink_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

} // namespace standin

/* Defines ORB_ID(name). */
#define ORB_ID(name) orb_id_of_##name()
#define STANDIN_TOPIC(name, queue)                                                                                     \
    inline orb_id_t orb_id_of_##name() {                                                                               \
        static const orb_metadata meta{#name, sizeof(name##_s), queue};                                                \
        return &meta;                                                                                                  \
    }
