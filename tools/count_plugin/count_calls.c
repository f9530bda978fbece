/* Counts instructions per call of chosen functions, exactly: a plugin of QEMU's code generator.
 * SPDX-License-Identifier: MIT
 *
 *   qemu-system-... -plugin count_calls.so,map=FILE,out=FILE
 *
 * map: one line per function, sorted by address: "<start> <end> <kind> <name>", numbers in hexadecimal, end exclusive.
 *   kind E  an entry: a call starts with its first instruction
 *        C  counted within calls: functions called by the entries
 *   Everything else is the caller: a call ends with the first instruction executed there.
 * out: one line per call: "<index of the entry> <total> <index>:<count> ...", indices being line numbers of the map
 *   from 0. Instructions are counted as executed; the figures repeat exactly.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "plugin_files.h"
#include "qemu_interface.h"

EXPORT int qemu_plugin_version = 1;

/* ----------------------------------------------------------------------------------------------------- functions -- */

#define FUNCTIONS_MAX 8192

typedef struct {
    uint64_t start, end;
    uint64_t count; /* instructions executed since a call started */
    bool entry;
} function_t;

static function_t functions[FUNCTIONS_MAX];
static int function_count;
static function_t *running; /* the entry whose call is running, or null */
static FILE *out;

static function_t *function_at(uint64_t address) {
    int low = 0;
    int high = function_count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (address >= functions[middle].end) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < function_count && address >= functions[low].start ? &functions[low] : NULL;
}

static bool read_map(const char *path) {
    char kind;
    FILE *file = fopen(path, "r");
    if (!file) {
        return false;
    }
    while (function_count < FUNCTIONS_MAX) {
        function_t *function = &functions[function_count];
        if (fscanf(file, "%" SCNx64 " %" SCNx64 " %c %*s", &function->start, &function->end, &kind) != 3) {
            break;
        }
        function->entry = kind == 'E';
        function_count++;
    }
    const bool whole = feof(file) != 0;
    (void)fclose(file);
    return whole && function_count > 0;
}

/* ------------------------------------------------------------------------------------------------------ counting -- */

static void end_call(void) {
    uint64_t total = 0;
    for (int i = 0; i < function_count; i++) {
        total += functions[i].count;
    }
    fprintf(out, "%d %" PRIu64, (int)(running - functions), total);
    for (int i = 0; i < function_count; i++) {
        if (functions[i].count > 0) {
            fprintf(out, " %d:%" PRIu64, i, functions[i].count);
        }
    }
    fputc('\n', out);
    running = NULL;
}

/* Called before the entry's first instruction is counted. Discards counts from outside of calls. */
static void on_entry(unsigned int cpu, void *data) {
    (void)cpu;
    if (!running) {
        running = data;
        for (int i = 0; i < function_count; i++) {
            functions[i].count = 0;
        }
    }
}

static void on_caller(unsigned int cpu, void *data) {
    (void)cpu;
    (void)data;
    if (running) {
        end_call();
    }
}

static void on_translated(qemu_plugin_id_t id, struct qemu_plugin_tb *block) {
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(block); i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(block, i);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        function_t *function = function_at(address);
        if (!function) {
            qemu_plugin_register_vcpu_insn_exec_cb(insn, on_caller, QEMU_PLUGIN_CB_NO_REGS, NULL);
            continue;
        }
        if (function->entry && address == function->start) {
            qemu_plugin_register_vcpu_insn_exec_cb(insn, on_entry, QEMU_PLUGIN_CB_NO_REGS, function);
        }
        qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &function->count, 1);
    }
}

static void on_exit_of_qemu(qemu_plugin_id_t id, void *data) {
    (void)id;
    (void)data;
    (void)fclose(out);
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv) {
    const plugin_files_t files = plugin_files(argc, argv);
    (void)info;
    out = files.out;
    if (!files.map || !out || !read_map(files.map)) {
        (void)fprintf(stderr, "count_calls: needs map=FILE (functions) and out=FILE (to write)\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translated);
    qemu_plugin_register_atexit_cb(id, on_exit_of_qemu, NULL);
    return 0;
}
