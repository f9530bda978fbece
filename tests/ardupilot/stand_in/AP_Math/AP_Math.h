/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <algorithm>
#include <cmath>

#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

enum Rotation { ROTATION_NONE = 0, ROTATION_PITCH_270 = 25 };

struct Vector2f {
    float x, y;
    Vector2f() : x(0.0f), y(0.0f) {}
    Vector2f(float x0, float y0) : x(x0), y(y0) {}
};

struct Vector3f {
    float x, y, z;
    Vector3f() : x(0.0f), y(0.0f), z(0.0f) {}
    Vector3f(float x0, float y0, float z0) : x(x0), y(y0), z(z0) {}
    float operator[](unsigned i) const { return i == 0 ? x : i == 1 ? y : z; }
};

struct Quaternion {
    float q1, q2, q3, q4;
    Quaternion() : q1(1.0f), q2(0.0f), q3(0.0f), q4(0.0f) {}
};

inline bool is_zero(float x) { return std::fabs(x) < 1.1920929e-7f; }
inline bool is_positive(float x) { return x >= 1.1920929e-7f; }
inline float sq(float x) { return x * x; }
inline float radians(float deg) { return deg * 0.01745329252f; }
inline float norm(float x, float y) { return std::sqrt(x * x + y * y); }
