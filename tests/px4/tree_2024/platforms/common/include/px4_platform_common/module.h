/* A stand-in for PX4's ModuleBase up to 1.16, a template: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "module_usage.hpp"

template <class T> class ModuleBase {
  public:
    virtual ~ModuleBase() = default;

    static int main(int argc, char *argv[]) {
        if (argc <= 1) {
            return T::print_usage();
        }
        if (strcmp(argv[1], "start") == 0) {
            return is_running() ? -1 : T::task_spawn(argc - 1, argv + 1);
        }
        if (strcmp(argv[1], "status") == 0) {
            return is_running() ? _object.load()->print_status() : -1;
        }
        return strcmp(argv[1], "stop") == 0 ? stop() : T::custom_command(argc - 1, argv + 1);
    }

    static bool is_running() { return _task_id != -1; }
    virtual int print_status() = 0;

  protected:
    static constexpr int task_id_is_work_queue = -2;

    bool should_exit() const { return _should_exit; }

    static void exit_and_cleanup() {
        delete _object.load();
        _object.store(nullptr);
        _task_id = -1;
    }

    static standin::Atomic<T *> _object;
    static int _task_id;

  private:
    static int stop() {
        if (is_running()) {
            static_cast<ModuleBase *>(_object.load())->_should_exit = true;
        }
        for (int i = 0; is_running() && i < standin::STOP_STEPS_MAX; i++) {
            standin::advance(standin::STOP_STEP_US);
        }
        return is_running() ? -1 : 0;
    }

    bool _should_exit{false};
};

template <class T> standin::Atomic<T *> ModuleBase<T>::_object;
template <class T> int ModuleBase<T>::_task_id = -1;
