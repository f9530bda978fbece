--[[
goe_plane.lua: ArduPlane flies past what goe_companion has found. SPDX-License-Identifier: MIT

The companion (reaction mode "off", reports on) sends GOE_HAZARD for each obstacle and GOE_STATUS once a second. An obstacle with
an order makes this script fly to the order's target in GUIDED, and back into the mode before when the obstacle is passed. Only
from AUTO and CRUISE, or while it circles after such an order; GO_AROUND only while landing in AUTO, or after a side: then it
raises the target. A landing is not gone on with after a side: from there the way to the runway is another one. Whoever chooses
another mode meanwhile is not fought, nor whoever sends the aircraft elsewhere in GUIDED.

Passed is an obstacle that the companion still reports, without an order any more. If it was given up, after HOLD, or if the
companion falls silent, the aircraft stays at the target, circling, and a text warns the pilot: what is not seen may lie ahead. It
flies a new order from there, and circles again at its end: only the pilot leads it back into the mode before.

The firmware's dialect need not know the messages: ArduPilot 4.7-dev hands scripts what its parser does not know, unsigned also
where the link is signed. The script therefore judges each message itself. With a key (KEY_FILES) only a message with a right and new
signature counts. Without a key only an unsigned message counts, and only while the autopilot itself takes unsigned messages from
the same sender on the same link: its HEARTBEAT shows that. On a signed link the autopilot drops an unsigned HEARTBEAT, so nothing
counts there; nor on a link on which anybody's signed HEARTBEAT comes.

No target counts that is farther than GOEP_DIST, lower than GOEP_ALT_MIN, far below or above the aircraft, or outside the fence.
]]

local HAZARD = { id = 42702, crc_extra = 62, length = 67 }
local STATUS = { id = 42703, crc_extra = 89, length = 33 }
local HEARTBEAT = { id = 0, crc_extra = 50, length = 9 } -- the parser knows it: scripts get it only if the link accepts it
local KINDS = { [HAZARD.id] = HAZARD, [STATUS.id] = STATUS, [HEARTBEAT.id] = HEARTBEAT }
local ORDER_FLAG = 0x20
local LEFT, RIGHT, CLIMB, GO_AROUND, HOLD = 1, 2, 3, 4, 5
local AUTO, CRUISE, GUIDED = 10, 7, 15
local DO_GO_AROUND = 191
local NOTHING_KNOWN = 2147483647 -- of latitudes and longitudes
local HEADER = 12                -- bytes of the message as scripts get it, before its payload
local CHECKSUM_AT = 277         -- as it was received, behind room for the longest payload
local SIGNATURE_AT = 279         -- behind that: link, 6 bytes of time in 10 us, 6 bytes of the hash
local SIGNED_FLAG = 0x01         -- of incompat_flags
local PERIOD_MS = 100
local SOON_MS = 10               -- while more is to be done: a part of a hash takes half of SCR_VM_I_COUNT's default
local QUEUE = 20                 -- messages
local TAKEN_AT_ONCE = 4          -- messages: the checksum of one takes a tenth of SCR_VM_I_COUNT's default
local BEAT_MS = 5000             -- after a HEARTBEAT: it comes once a second
local SILENCE_MS = 3000          -- a link may lose two GOE_STATUS
local RENEW_MS = 1000            -- the target moves as the estimate does
local DOWN_FAR_M = 100000        -- a height beyond this is none
local BELOW_M = 10               -- no order leads down: so far below the aircraft a target may lie by noise
local ELSEWHERE_M = 20           -- a target that far from the one of the order is another's: far above rounding
local ABOVE_M = 150              -- a climb over the highest mast that the companion's defaults expect
local TEXT_WARNING, TEXT_INFO = 4, 6
local FENCE_ALT_MAX, FENCE_CIRCLE, FENCE_POLYGON, FENCE_ALT_MIN = 1, 2, 4, 8 -- bits of FENCE_TYPE
local KEY_FILES = { "APM/goe.key", "goe.key" }                               -- on a board's card, in a simulator's folder

local PREFIX = "GOEP_"
local TABLE = 187
assert(param:add_table(TABLE, PREFIX, 4), "goe: no table of parameters")

local function parameter(index, name, value)
    assert(param:add_param(TABLE, index, name, value), "goe: no parameter")
    return Parameter(PREFIX .. name)
end

local enable = parameter(1, "ENABLE", 1)
local far_m = parameter(2, "DIST", 500)       -- m: no target farther from the aircraft; 0: none at all
local low_m = parameter(3, "ALT_MIN", 20)     -- m above home: neither a target nor an aircraft below it
local any_polygon = parameter(4, "POLYGON", 0) -- 1: fly orders although no script can see a polygon fence

local own_system = param:get("MAV_SYSID") or param:get("SYSID_THISMAV") or 1

local mode_before -- while this script has changed the mode
local mode_led -- in which the order is flown: GUIDED, or AUTO after a go-around
local from_landing = false -- it was landing then
local circling = false -- in GUIDED, at the target of an order that ended, until the pilot decides
local overruled = false -- another mode or another target was chosen: until the order ends
local held -- lat, lon of the latest target that was flown to
local standing -- the order: named, doubts, action, lat, lon, down; over_ms: since then the companion gives none.
-- named: by its place in the table, each obstacle that the order was about: number; is_past: it is reported without an order;
-- heard_ms, renumbered: when it was last reported with one, and the companion's count then.
-- doubts: for each obstacle that was not past when its place got another number, that count
local renumbered = math.huge -- tracks with a new number, as the companion counted them last; before that, none is known to have one
local received_ms = uint32_t(0)
local sent_ms = uint32_t(0)
local silence_reported = false
local said = {} -- texts that were sent once, and are not sent again

local function say(severity, text)
    gcs:send_text(severity, "GOE: " .. text)
end

local function say_once(text)
    if not said[text] then
        said[text] = true
        say(TEXT_WARNING, text)
    end
end

-- ------------------------------------------------------------------------------------------------------------- whose it is

local function checksum(bytes)
    local crc = 0xFFFF
    for i = 1, #bytes do
        local x = bytes:byte(i) ~ (crc & 0xFF)
        x = (x ~ (x << 4)) & 0xFF
        crc = ((crc >> 8) ~ (x << 8) ~ (x << 3) ~ (x >> 4)) & 0xFFFF
    end
    return crc
end

local function id_of(message)
    return (string.unpack("<I3", message, 10))
end

local function is_signed(message)
    return message:byte(5) & SIGNED_FLAG ~= 0
end

-- Link, system and component.
local function sender_of(message, link)
    return string.char(link) .. message:sub(8, 9)
end

-- A whole message of that kind: bytes on the wire from the length on, without the checksum. nil: it is none. The checksum at the
-- beginning is the parser's own where a message is signed: without the seed of a kind that it does not know.
local function frame_of(message, kind)
    local crc, length = string.unpack("<H", message, CHECKSUM_AT), message:byte(4)
    if length > kind.length then
        return nil
    end
    local frame = message:sub(4, HEADER + length)
    return checksum(frame .. string.char(kind.crc_extra)) == crc and frame or nil
end

-- The payload, with the zeros that the wire leaves out.
local function payload_of(message, kind)
    local length = message:byte(4)
    return message:sub(HEADER + 1, HEADER + length) .. string.rep("\0", kind.length - length)
end

-- --------------------------------------------------------------------------------------------------------- signature, FIPS 180-4

local new_hash, go_on_hashing
do
    local WORD = 0xFFFFFFFF -- integers have 32 bits in ArduPilot, 64 elsewhere: the same code for both
    local ROUND = {
        0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
        0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
        0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
        0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
        0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
        0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
        0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
        0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2,
    }
    local BLOCK = 64

    -- One block into the eight words of the hash.
    local function hash_block(hash, text, at)
        local w = { string.unpack(">I4I4I4I4I4I4I4I4I4I4I4I4I4I4I4I4", text, at) }
        for i = 17, 64 do
            local x, y = w[i - 15], w[i - 2]
            w[i] = (w[i - 16] + w[i - 7] + (((x >> 7) | (x << 25)) ~ ((x >> 18) | (x << 14)) ~ (x >> 3)) +
                (((y >> 17) | (y << 15)) ~ ((y >> 19) | (y << 13)) ~ (y >> 10))) & WORD
        end
        local a, b, c, d, e, f, g, h = table.unpack(hash)
        for i = 1, 64 do
            local one = h + (((e >> 6) | (e << 26)) ~ ((e >> 11) | (e << 21)) ~ ((e >> 25) | (e << 7))) +
                (g ~ (e & (f ~ g))) + ROUND[i] + w[i]
            local two = (((a >> 2) | (a << 30)) ~ ((a >> 13) | (a << 19)) ~ ((a >> 22) | (a << 10))) + ((a & b) | (c & (a | b)))
            h, g, f, e, d, c, b, a = g, f, e, (d + one) & WORD, c, b, a, (one + two) & WORD
        end
        local words = { a, b, c, d, e, f, g, h }
        for i = 1, 8 do
            hash[i] = (hash[i] + words[i]) & WORD
        end
    end

    function new_hash(text)
        local zeros = (BLOCK - (#text + 9) % BLOCK) % BLOCK
        return {
            words = { 0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19 },
            text = text .. "\x80" .. string.rep("\0", zeros + 4) .. string.pack(">I4", 8 * #text),
            at = 1,
        }
    end

    -- One block more; true: that was the last one.
    function go_on_hashing(work)
        hash_block(work.words, work.text, work.at)
        work.at = work.at + BLOCK
        return work.at > #work.text
    end
end

-- 32 bytes, or 64 hexadecimal digits. nil: there is no file; false: there is one, which is none.
local function read_key()
    for _, name in ipairs(KEY_FILES) do
        local file = io.open(name, "rb")
        if file then
            local text = file:read(100) or ""
            file:close()
            local digits = text:match("^%s*(%x+)%s*$")
            if digits and #digits == 64 then
                return (digits:gsub("%x%x", function(pair) return string.char(tonumber(pair, 16)) end))
            end
            return #text == 32 and text
        end
    end
    return nil
end

local key = read_key()

-- ------------------------------------------------------------------------------------------------------------- what it says

local take
do
    -- Another number at a place is the same track, renumbered, or another obstacle. A track is reported without a pause.
    local function doubt_another(before, number, doubts)
        if before and before.number ~= number and not before.is_past then
            local has_paused = millis() - before.heard_ms > SILENCE_MS
            doubts[#doubts + 1] = has_paused and math.huge or before.renumbered
        end
    end

    local function take_hazard(payload)
        local lat, lon, _, _, down = string.unpack("<i4i4fff", payload, 13)
        local action, flags = string.unpack("<BB", payload, 66)
        local number, place = payload:sub(9, 12), payload:byte(65)
        if flags & ORDER_FLAG == 0 or action == 0 then
            local one = standing and standing.named[place]
            if one and one.number == number then
                one.is_past = true
            end
            return
        end
        if action > HOLD then
            return
        end
        if action ~= GO_AROUND and (lat == NOTHING_KNOWN or lon == NOTHING_KNOWN or not (math.abs(down) < DOWN_FAR_M)) then
            return
        end
        local named, doubts = standing and standing.named or {}, standing and standing.doubts or {}
        doubt_another(named[place], number, doubts)
        named[place] = { number = number, is_past = false, heard_ms = millis(), renumbered = renumbered }
        standing = { named = named, doubts = doubts, action = action, lat = lat, lon = lon, down = down }
    end

    -- A doubt is over if a track has got a new number since then. Otherwise it is never over: the obstacle was given up.
    local function judge_doubts()
        local kept = {}
        for _, count in ipairs(standing.doubts) do
            if count >= renumbered then
                kept[#kept + 1] = math.huge
            end
        end
        standing.doubts = kept
    end

    local function take_status(payload)
        renumbered = string.unpack("<H", payload, 15)
        local has_ended = string.unpack("<B", payload, 30) == 0
        if not standing then
            overruled = overruled and not has_ended -- the order ended in a silence
            return
        end
        judge_doubts()
        if not has_ended then
            standing.over_ms = nil
        elseif not standing.over_ms then
            standing.over_ms = millis()
        end
    end

    function take(payload, kind)
        received_ms = millis()
        if kind == HAZARD then
            take_hazard(payload)
        else
            take_status(payload)
        end
    end
end

local receive
do
    local beat_ms = {}   -- by sender: when the autopilot took an unsigned HEARTBEAT of it
    local signed_ms = {} -- by link: when the autopilot took a signed HEARTBEAT of anybody
    local newest = {}    -- by sender: low and high half of the time of its latest right signature
    local judged         -- the signed message that is being hashed
    local latest         -- its signature, or that of the one before: the parser hands an unknown signed message over once more when
    -- the next one's checksum comes

    -- A signature's time grows with each message of a sender. An old one is a message that somebody plays once more.
    local function is_new(sender, message)
        local low, high = string.unpack("<I3I3", message, SIGNATURE_AT + 1)
        local last = newest[sender]
        if last and (high < last.high or (high == last.high and low <= last.low)) then
            return false
        end
        return true, { low = low, high = high }
    end

    local function begin_judging(message, link, kind, frame)
        local signature = message:sub(SIGNATURE_AT, SIGNATURE_AT + 12)
        if signature == latest then
            return
        end
        latest = signature
        judged = {
            message = message,
            kind = kind,
            sender = sender_of(message, link) .. signature:sub(1, 1),
            signature = signature,
            work = new_hash(key .. message:sub(3, 3) .. frame .. message:sub(CHECKSUM_AT, CHECKSUM_AT + 1) .. signature:sub(1, 7)),
        }
    end

    local function go_on_judging()
        local of = judged
        if not go_on_hashing(of.work) then
            return
        end
        judged = nil
        local hash = string.pack(">I4I4", of.work.words[1], of.work.words[2])
        local new, time = is_new(of.sender, of.message)
        if hash:sub(1, 6) ~= of.signature:sub(8) or not new then
            say_once("wrong or old signature, ignored")
            return
        end
        newest[of.sender] = time
        take(payload_of(of.message, of.kind), of.kind)
    end

    local function is_recent(when_ms)
        return when_ms and millis() - when_ms <= BEAT_MS
    end

    -- A HEARTBEAT comes only where the autopilot takes it: what it shows is how the link is used.
    local function take_heartbeat(message, link)
        if not frame_of(message, HEARTBEAT) then
            return
        elseif is_signed(message) then
            signed_ms[link] = millis()
        else
            beat_ms[sender_of(message, link)] = millis()
        end
    end

    -- Whether a message may count at all, which costs less to know than its checksum. What the parser does not know comes as it is.
    local function may_count(message, link)
        local is_open = is_recent(beat_ms[sender_of(message, link)]) and not is_recent(signed_ms[link])
        if message:byte(8) ~= own_system then
            return false
        elseif is_signed(message) and not key then
            say_once("signed message and no goe.key, ignored")
            return false
        elseif not is_signed(message) and (key or not is_open) then
            say_once("unsigned message, ignored")
            return false
        end
        return true
    end

    local function take_message(message, link)
        local kind = KINDS[id_of(message)]
        if key == false or not kind then
            return
        elseif kind == HEARTBEAT then
            take_heartbeat(message, link)
            return
        end
        local frame = may_count(message, link) and frame_of(message, kind)
        if not frame then
            return
        elseif key then
            begin_judging(message, link, kind, frame)
        else
            take(payload_of(message, kind), kind)
        end
    end

    -- True: there may be more to do.
    function receive()
        if judged then
            go_on_judging()
            return true
        end
        for _ = 1, TAKEN_AT_ONCE do
            local message, link = mavlink:receive_chan()
            if not message then
                return false
            end
            take_message(message, link)
            if judged then
                return true
            end
        end
        return true
    end
end

-- ------------------------------------------------------------------------------------------------------------------ bounds

local function value_of(name)
    return param:get(name) or 0
end

local function fence_kinds()
    if value_of("FENCE_ENABLE") < 1 and value_of("FENCE_AUTOENABLE") < 1 then
        return 0
    end
    return math.floor(value_of("FENCE_TYPE"))
end

-- Why the fence forbids a height above home; nil: it does not.
local function fence_forbids_height(up_m)
    local kinds = fence_kinds()
    local margin_m = value_of("FENCE_MARGIN")
    if kinds & FENCE_ALT_MAX ~= 0 and up_m > value_of("FENCE_ALT_MAX") - margin_m then
        return "above the fence"
    elseif kinds & FENCE_ALT_MIN ~= 0 and up_m < value_of("FENCE_ALT_MIN") + margin_m then
        return "below the fence"
    end
    return nil
end

-- The same of a place. What the firmware does at a fence, it still does.
local function fence_forbids_place(place)
    local kinds = fence_kinds()
    local radius_left_m = value_of("FENCE_RADIUS") - value_of("FENCE_MARGIN") - math.abs(value_of("WP_LOITER_RAD"))
    if kinds & FENCE_CIRCLE ~= 0 and ahrs:get_home():get_distance(place) > radius_left_m then
        return "outside the fence"
    elseif kinds & FENCE_POLYGON ~= 0 and value_of("FENCE_TOTAL") > 0 and any_polygon:get() < 1 then
        return "polygon fence, not visible"
    end
    return nil
end

-- Why no aircraft is led to a place; nil: it may be.
local function forbids(place)
    local here = ahrs:get_location()
    if not here or not ahrs:home_is_set() then
        return "no position or no home"
    end
    local home_cm = ahrs:get_home():alt()
    local up_m = 0.01 * (place:alt() - home_cm)
    local rise_m = 0.01 * (place:alt() - here:alt())
    if not (here:get_distance(place) <= far_m:get()) then
        return "too far"
    elseif up_m < low_m:get() or 0.01 * (here:alt() - home_cm) < low_m:get() then
        return "too low"
    elseif rise_m < -BELOW_M then
        return "too far below"
    elseif rise_m > ABOVE_M then
        return "too far above"
    end
    return fence_forbids_height(up_m) or fence_forbids_place(place)
end

-- The origin, at the height of the order; nil: one of them is not known.
local function origin_at_height()
    local place = ahrs:get_origin()
    if not place or not (math.abs(standing.down) < DOWN_FAR_M) then
        return nil
    end
    place:alt(place:alt() - math.floor(100 * standing.down))
    return place
end

-- Where the order leads to; nil: nowhere, or not where an aircraft may be led to. A go-around after a side keeps the place of the side,
-- because the layer found the way there clear. It raises the height, because the layer counts on the climb.
local function target()
    local place = origin_at_height()
    if not place then
        return nil
    end
    local at = standing.action == GO_AROUND and held or standing
    place:lat(at.lat)
    place:lng(at.lon)
    local why = forbids(place)
    if why then
        say_once("order not flown: " .. why)
        return nil
    end
    return place
end

-- ------------------------------------------------------------------------------------------------------------------ orders

-- A target that is out of bounds meanwhile leaves the aircraft at the one before.
local function fly_to_target()
    local place = target()
    if place and vehicle:set_target_location(place) then
        sent_ms = millis()
        held = { lat = place:lat(), lon = place:lng() }
    end
end

-- Whether somebody else has given GUIDED a target: the mode does not show that.
local function is_sent_elsewhere()
    local place, there = ahrs:get_origin(), vehicle:get_target_location()
    if not held or not place or not there then
        return false
    end
    place:lat(held.lat)
    place:lng(held.lon)
    return place:get_distance(there) > ELSEWHERE_M
end

-- Above home, over the obstacle's top; nil: the autopilot's own height for an aborted landing.
local function height_to_climb_m()
    local place, here = origin_at_height(), ahrs:get_location()
    if not place or not here or not ahrs:home_is_set() then
        return nil
    end
    local up_m = 0.01 * (place:alt() - ahrs:get_home():alt())
    local rise_m = 0.01 * (place:alt() - here:alt())
    if rise_m < 1 or rise_m > ABOVE_M or fence_forbids_height(up_m) then
        return nil
    end
    return up_m
end

-- Once; the landing sequence goes on from there.
local function go_around()
    if not mode_led and vehicle:get_mode() == AUTO and vehicle:is_landing() then
        say(TEXT_WARNING, "go around")
        gcs:run_command_int(DO_GO_AROUND, { p1 = height_to_climb_m() })
        mode_led = AUTO
    end
end

local function begin_order()
    local mode = vehicle:get_mode()
    local is_landing = mode == AUTO and vehicle:is_landing()
    if standing.action == GO_AROUND then
        go_around()
    elseif (mode == AUTO or mode == CRUISE or circling) and not vehicle:is_taking_off() and target() and
        (circling or vehicle:set_mode(GUIDED)) then
        mode_before, from_landing, held = mode, is_landing or mode_led == AUTO or (circling and from_landing), nil
        mode_led = GUIDED
        say(TEXT_WARNING, "flying past an obstacle")
        fly_to_target()
    elseif is_landing then -- to its target no side may be flown: up at least
        go_around()
    end
end

local function leave_to_others(what)
    mode_before, mode_led = nil, nil
    overruled = true
    say(TEXT_INFO, "left to whoever chose the " .. what)
end

local function follow_order()
    if overruled then
        return
    end
    if mode_led and vehicle:get_mode() ~= mode_led then
        leave_to_others("mode")
    elseif not mode_before then
        begin_order()
    elseif millis() - sent_ms > RENEW_MS then
        if is_sent_elsewhere() then
            leave_to_others("target")
        else
            fly_to_target()
        end
    end
end

-- One that was given up is reported no more; then the worst other one carries the order.
local function are_all_past()
    for _, one in pairs(standing.named) do
        if not one.is_past then
            return false
        end
    end
    return #standing.doubts == 0
end

local function is_passed()
    local action = standing.action
    return are_all_past() and not from_landing and (action == LEFT or action == RIGHT or action == CLIMB)
end

local function forget_order()
    standing, mode_before, mode_led, overruled = nil, nil, nil, false
end

local function end_order()
    if mode_before and vehicle:get_mode() == GUIDED and not is_sent_elsewhere() then
        if is_passed() and not circling then
            say(TEXT_INFO, "past it")
            vehicle:set_mode(mode_before)
        else
            say(TEXT_WARNING, (from_landing and "broke off landing" or "not surely past") .. ", circling: pilot to decide")
            circling = true
        end
    end
    forget_order()
    said = {}
end

-- Its report without an order may come after the word that there is none.
local function is_over()
    return standing.over_ms and
        (are_all_past() or not mode_before or millis() - standing.over_ms > SILENCE_MS)
end

-- An order stays active, at its target, while no message arrives.
local function watch_silence()
    local silent = millis() - received_ms > SILENCE_MS
    if silent and mode_before and not silence_reported then
        say(TEXT_WARNING, "companion silent, circling: pilot to decide")
    end
    silence_reported = silent and mode_before ~= nil
    return silent
end

local function update()
    local is_busy = receive()
    circling = circling and arming:is_armed() and vehicle:get_mode() == GUIDED and not is_sent_elsewhere()
    if enable:get() < 1 or not arming:is_armed() then
        forget_order()
    elseif standing then
        local silent = watch_silence()
        if is_over() then
            end_order()
        elseif silent and not mode_before then
            standing, mode_led = nil, nil
        elseif not standing.over_ms then
            follow_order()
        end
    end
    return update, is_busy and SOON_MS or PERIOD_MS
end

mavlink:init(QUEUE, 3)
mavlink:register_rx_msgid(HAZARD.id)
mavlink:register_rx_msgid(STATUS.id)
mavlink:register_rx_msgid(HEARTBEAT.id)
if key == false then
    say(TEXT_WARNING, "goe.key holds no key: nothing is believed")
else
    say(TEXT_INFO, key and "script runs, signed messages only" or "script runs")
end

return update()
