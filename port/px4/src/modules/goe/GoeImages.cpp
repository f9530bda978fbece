/* Images that wait for a pose as new as they are. SPDX-License-Identifier: MIT */
#include "GoeImages.hpp"

static constexpr uint32_t US_PER_S = 1000000;
static constexpr float MS_PER_US = 1.0e-3f;

void GoeImages::note_lost(unsigned images) {
    const unsigned free_place = UINT16_MAX - _overdue;
    _overdue = static_cast<uint16_t>(_overdue + (images < free_place ? images : free_place));
}

void GoeImages::keep(uint32_t now_us) {
    _kept_us[(_first + _count) % PLACES] = now_us;
    _count++;
    if (_count > ROOM) {
        _first = (_first + 1u) % PLACES;
        _count--;
        note_lost(1u);
    }
}

void GoeImages::note_delay(uint32_t delay_us) {
    _sum_us += delay_us;
    _max_us = delay_us > _max_us ? delay_us : _max_us;
    _images++;
}

/* The pointer in a sighting is to its own detection. */
void GoeImages::move(unsigned from, unsigned to) {
    _image[to] = _image[from];
    _image[to].frame.detection = &_image[to].detection;
    _kept_us[to] = _kept_us[from];
}

/* An exposure so long after the arrival is a time of another clock: no pose comes for it in time. */
static bool is_of_another_clock(const goe_flight_frame_t &frame) {
    const int32_t ahead_us = static_cast<int32_t>(frame.capture_us - frame.arrival_us);
    return frame.time_base == GOE_FLIGHT_AUTOPILOT_CLOCK && ahead_us > static_cast<int32_t>(GoeImages::WAIT_MAX_US);
}

/* False: its pose may still come. */
bool GoeImages::take_one(goe_flight_t &flight, unsigned place, uint32_t now_us) {
    const goe_flight_frame_t &frame = _image[place].frame;
    const goe_flight_status_t status = goe_flight_frame(&flight, &frame);
    if (status == GOE_FLIGHT_TOO_NEW) {
        const bool waits = now_us - _kept_us[place] < WAIT_MAX_US && !is_of_another_clock(frame);
        if (!waits) {
            note_lost(1u);
        }
        return !waits;
    }
    if (status == GOE_FLIGHT_OK && (_images == 0 || flight.capture_us != _capture_us)) {
        _capture_us = flight.capture_us;
        note_delay(now_us - flight.capture_us);
    }
    return true;
}

void GoeImages::take(goe_flight_t &flight, uint32_t now_us) {
    unsigned kept = 0;
    for (unsigned i = 0; i < _count; i++) {
        const unsigned place = (_first + i) % PLACES;
        if (!take_one(flight, place, now_us)) {
            const unsigned to = (_first + kept) % PLACES;
            if (to != place) {
                move(place, to);
            }
            kept++;
        }
    }
    _count = kept;
}

GoeImages::Delays GoeImages::delays(uint32_t now_us) {
    const uint32_t passed_us = now_us - _second_us;
    if (passed_us >= US_PER_S) {
        const float images = static_cast<float>(_images);
        _delays.known = _images > 0;
        _delays.mean_ms = _delays.known ? MS_PER_US * static_cast<float>(_sum_us) / images : 0.f;
        _delays.max_ms = MS_PER_US * static_cast<float>(_max_us);
        _delays.rate_hz = images * static_cast<float>(US_PER_S) / static_cast<float>(passed_us);
        _second_us = now_us;
        _sum_us = _max_us = _images = 0;
    }
    return _delays;
}
