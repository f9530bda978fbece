/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <cstdint>
#include <cstring>
#include <new>

#define CLASS_NO_COPY(c)                                                                                               \
    c(const c &other) = delete;                                                                                        \
    c &operator=(const c &) = delete

struct ScriptedHeap {};
void *operator new(size_t size, const ScriptedHeap &heap) noexcept;
#define NEW_NOTHROW new (ScriptedHeap{})

struct Location {
    int32_t alt, lat, lng; // cm, degrees times 1e7
};
