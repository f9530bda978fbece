/* Images that wait for a pose as new as they are. SPDX-License-Identifier: MIT */
#pragma once

#include "goe_flight.h"
#include "goe_mavlink_map.h"

/* In the order of arrival; an image that waits does not delay those after it. A sighting contains a pointer into itself, so it is filled
 * in place. */
class GoeImages {
  public:
    static constexpr unsigned ROOM = 8;
    static constexpr uint32_t WAIT_MAX_US = 500000; /* a pose that has not come by then comes no more */

    /* Room for one more, to be filled and then kept. If too many wait the oldest one goes then, and is counted. */
    goe_mavlink_sighting_t &free_place() { return _image[(_first + _count) % PLACES]; }
    void keep(uint32_t now_us);
    void note_lost(unsigned images); /* that never came here: counted as overdue */

    /* Gives the layer what it can take by now. */
    void take(goe_flight_t &flight, uint32_t now_us);
    void forget() { _count = 0; }

    /* Since the start. */
    uint16_t overdue() const { return _overdue; }

    /* From the exposure to here, of the images taken in the last whole second. */
    struct Delays {
        bool known;
        float mean_ms, max_ms, rate_hz;
    };
    Delays delays(uint32_t now_us);

  private:
    static constexpr unsigned PLACES = ROOM + 1; /* one to be filled */

    bool take_one(goe_flight_t &flight, unsigned place, uint32_t now_us);
    void move(unsigned from, unsigned to);
    void note_delay(uint32_t delay_us);

    goe_mavlink_sighting_t _image[PLACES]{};
    uint32_t _kept_us[PLACES]{}; /* when each came here: its own times may be of a clock that is off */
    unsigned _first{0}, _count{0};
    uint16_t _overdue{0};
    Delays _delays{};
    uint32_t _second_us{0}, _sum_us{0}, _max_us{0}, _images{0}; /* of the present second */
    uint32_t _capture_us{0}; /* of the image noted last: one may come in several messages */
};
