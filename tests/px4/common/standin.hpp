/* The stand-in for PX4 in the tests: a broker of topics, a work queue, a clock, parameters and a console that the tests control.
 * SPDX-License-Identifier: MIT
 *
 * Written for this project, with only the names that port/px4 uses. They were compared with PX4 main of 2 March 2026 (tree_2026)
 * and of 20 December 2024, after 1.15 (tree_2024: the older form of ModuleBase, C++14); detect_and_avoid with the message's page
 * of August 2026, the landing's two topics with main of 13 February 2025. It reproduces this behavior of PX4: a subscriber reads each
 * message of a queue once, the oldest remaining one first, and finds the latest one that was published before it subscribed; a callback
 * schedules the work item; nothing runs immediately. */
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

/* Clears all topics, parameters, texts and scheduled work; the clock starts at start_us. */
void begin(uint64_t start_us);

uint64_t now_us();
void set_clock(uint64_t us); /* jumps: timers keep the rest of their interval */
void advance(uint64_t us);   /* the clock advances, and due or scheduled work runs */
void settle();               /* scheduled work runs */

/* Topics. */
void publish(orb_id_t topic, const void *data, uint8_t instance = 0);
unsigned published(orb_id_t topic, uint8_t instance = 0);
bool copy(orb_id_t topic, uint8_t instance, unsigned &generation, void *data); /* false: no newer message */
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

/* Parameters of module.yaml, by name; set() publishes parameter_update. */
void set(const char *parameter, float value);
void set(const char *parameter, int32_t value);
void set_other(const char *parameter, float value); /* of another module: it does not exist before */
bool is_used(const char *parameter);

/* Printed text, and text sent to ground stations. */
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
