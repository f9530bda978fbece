/* A stand-in for PX4's ModuleBase since 1.17, a class with a descriptor for each module: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "module_usage.hpp"

class ModuleBase {
  public:
    struct Descriptor {
        Descriptor(int (*spawn)(int, char **), int (*custom)(int, char **), int (*usage)(const char *))
            : task_spawn(spawn), custom_command(custom), print_usage(usage) {}
        int (*task_spawn)(int argc, char *argv[]);
        int (*custom_command)(int argc, char *argv[]);
        int (*print_usage)(const char *reason);
        standin::Atomic<ModuleBase *> object;
        int task_id{-1};
    };

    virtual ~ModuleBase() = default;

    static int main(Descriptor &desc, int argc, char *argv[]) {
        if (argc <= 1) {
            return desc.print_usage(nullptr);
        }
        if (strcmp(argv[1], "start") == 0) {
            return is_running(desc) ? -1 : desc.task_spawn(argc - 1, argv + 1);
        }
        if (strcmp(argv[1], "status") == 0) {
            return is_running(desc) ? desc.object.load()->print_status() : -1;
        }
        return strcmp(argv[1], "stop") == 0 ? stop(desc) : desc.custom_command(argc - 1, argv + 1);
    }

    static bool is_running(const Descriptor &desc) { return desc.task_id != -1; }
    virtual int print_status() = 0;
    bool should_exit() const { return _should_exit; }

    static void exit_and_cleanup(Descriptor &desc) {
        delete desc.object.load();
        desc.object.store(nullptr);
        desc.task_id = -1;
    }

    static constexpr int task_id_is_work_queue = -2;

  private:
    static int stop(Descriptor &desc) {
        if (is_running(desc)) {
            desc.object.load()->_should_exit = true;
        }
        for (int i = 0; is_running(desc) && i < standin::STOP_STEPS_MAX; i++) {
            standin::advance(standin::STOP_STEP_US);
        }
        return is_running(desc) ? -1 : 0;
    }

    bool _should_exit{false};
};
