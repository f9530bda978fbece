/* Images that wait for a pose as new as they are. SPDX-License-Identifier: MIT */
#include "GoeImages.hpp"

static constexpr uint32_t US_PER_S = 1000000;
static constexpr float MS_PER_US = 1.0e-3f;

void GoeImages::drop() {
    _first = (_first + 1u) % PLACES;
    _count--;
}

void GoeImages::note_lost(unsigned images) {
    const unsigned free_place = UINT16_MAX - _overdue;
    _overdue = static_cast<uint16_t>(_overdue + (images < free_place ? images : free_place));
}

void GoeImages::give_up() {
    drop();
    note_lost(1u);
}

void GoeImages::keep(uint32_t now_us) {
    _kept_us[(_first + _count) % PLACES] = now_us;
    _count++;
    if (_count > ROOM) {
        give_up();
    }
}

void GoeImages::note_delay(uint32_t delay_us) {
    _sum_us += delay_us;
    _max_us = delay_us > _max_us ? delay_us : _max_us;
    _images++;
}

void GoeImages::take(goe_flight_t &flight, uint32_t now_us) {
    while (_count > 0) {
        const goe_flight_frame_t &frame = oldest().frame;
        const uint32_t waited_us = now_us - _kept_us[_first];
        const goe_flight_status_t status = goe_flight_frame(&flight, &frame);
        if (status == GOE_FLIGHT_TOO_NEW && waited_us < WAIT_MAX_US) {
            return;
        }
        if (status == GOE_FLIGHT_TOO_NEW) {
            give_up();
            continue;
        }
        if (status == GOE_FLIGHT_OK && (_images == 0 || flight.capture_us != _capture_us)) {
            _capture_us = flight.capture_us;
            note_delay(now_us - flight.capture_us);
        }
        drop();
    }
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
