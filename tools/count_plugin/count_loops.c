/* Largest number of turns of loops, and largest sums of calls: a plugin of QEMU's code generator.
 * SPDX-License-Identifier: MIT
 *
 *   qemu-system-... -plugin count_loops.so,map=FILE,out=FILE
 *
  * map: a line for each event at an address, numbers except the address decimal:
  *   "count <address> <counter>"   increments the counter
  *   "less <address> <counter>"    decrements it
  *   "reset <address> <counter>"   resets it to 0; comes first if several events are at an address
  *   "needs <counter> <switch>"    the counter is active only while the switch is on
  *   "bars <counter> <switch>"     ... only while it is off
  *   "on <address> <switch>", "off <address> <switch>"
  * out: the maximum of each counter, one per line. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "plugin_files.h"
#include "qemu_interface.h"

EXPORT int qemu_plugin_version = 1;

#define COUNTERS_MAX 2048
#define SWITCHES_MAX 64
#define EVENTS_MAX 32768
#define KINDS 5

typedef struct {
    int64_t count, most;
    uint64_t needs, bars; /* sets of switches */
} counter_t;

typedef struct {
    uint64_t address;
    void *of; /* counter, or the switch's bit */
    executed_t does;
    int order; /* at one address */
} event_t;

static counter_t counters[COUNTERS_MAX];
static uint64_t bit[SWITCHES_MAX];
static uint64_t switches_on;
static event_t events[EVENTS_MAX];
static size_t event_count;
static size_t counter_count;
static FILE *out;

static void count_by(counter_t *counter, int64_t more) {
    if ((switches_on & counter->needs) == counter->needs && (switches_on & counter->bars) == 0) {
        counter->count += more;
        counter->most = counter->count > counter->most ? counter->count : counter->most;
    }
}

static void on_count(unsigned int cpu, void *data) {
    (void)cpu;
    count_by(data, 1);
}

static void on_less(unsigned int cpu, void *data) {
    (void)cpu;
    count_by(data, -1);
}

static void on_reset(unsigned int cpu, void *data) {
    (void)cpu;
    ((counter_t *)data)->count = 0;
}

static void on_on(unsigned int cpu, void *data) {
    (void)cpu;
    switches_on |= *(const uint64_t *)data;
}

static void on_off(unsigned int cpu, void *data) {
    (void)cpu;
    switches_on &= ~*(const uint64_t *)data;
}

/* ---------------------------------------------------------------------------------------------------------- map -- */

static bool add_event(const char *kind, uint64_t address, unsigned number) {
    static const char *const kinds[] = {"off", "on", "reset", "less", "count"};
    static const executed_t does[] = {on_off, on_on, on_reset, on_less, on_count};
    for (int i = 0; i < KINDS; i++) {
        if (strcmp(kind, kinds[i]) == 0 && event_count < EVENTS_MAX && number < (i < 2 ? SWITCHES_MAX : COUNTERS_MAX)) {
            void *of = i < 2 ? (void *)&bit[number] : (void *)&counters[number];
            const event_t event = {address, of, does[i], i};
            events[event_count++] = event;
            counter_count = i >= 2 && number >= counter_count ? number + 1 : counter_count;
            return true;
        }
    }
    return false;
}

static bool add_condition(const char *kind, unsigned number, unsigned of_switch) {
    if (number >= COUNTERS_MAX || of_switch >= SWITCHES_MAX) {
        return false;
    }
    uint64_t *set = strcmp(kind, "needs") == 0 ? &counters[number].needs : &counters[number].bars;
    *set |= bit[of_switch];
    return true;
}

static bool read_map(const char *path) {
    char kind[8];
    char address[24];
    unsigned number;
    int fields = 0;
    bool good = true;
    FILE *file = fopen(path, "r");
    if (!file) {
        return false;
    }
    while (good && (fields = fscanf(file, "%7s %23s %u", kind, address, &number)) == 3) {
        uint64_t value = 0;
        if (strcmp(kind, "needs") == 0 || strcmp(kind, "bars") == 0) {
            good = sscanf(address, "%" SCNu64, &value) == 1 && add_condition(kind, (unsigned)value, number);
        } else {
            good = sscanf(address, "%" SCNx64, &value) == 1 && add_event(kind, value, number);
        }
    }
    (void)fclose(file);
    return good && fields == EOF && event_count > 0;
}

/* ---------------------------------------------------------------------------------------------------------- QEMU -- */

/* Callbacks run in the order in which they are registered. */
static void on_translated(qemu_plugin_id_t id, struct qemu_plugin_tb *block) {
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(block); i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(block, i);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        for (int order = 0; order < KINDS; order++) {
            for (size_t k = 0; k < event_count; k++) {
                if (events[k].address == address && events[k].order == order) {
                    qemu_plugin_register_vcpu_insn_exec_cb(insn, events[k].does, QEMU_PLUGIN_CB_NO_REGS, events[k].of);
                }
            }
        }
    }
}

static void on_exit_of_qemu(qemu_plugin_id_t id, void *data) {
    (void)id;
    (void)data;
    for (size_t i = 0; i < counter_count; i++) {
        fprintf(out, "%" PRId64 "\n", counters[i].most);
    }
    (void)fclose(out);
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv) {
    const plugin_files_t files = plugin_files(argc, argv);
    (void)info;
    for (unsigned i = 0; i < SWITCHES_MAX; i++) {
        bit[i] = (uint64_t)1 << i;
    }
    out = files.out;
    if (!files.map || !out || !read_map(files.map)) {
        (void)fprintf(stderr, "count_loops: needs map=FILE (events) and out=FILE (to write)\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translated);
    qemu_plugin_register_atexit_cb(id, on_exit_of_qemu, NULL);
    return 0;
}
