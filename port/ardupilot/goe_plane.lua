--[[
goe_plane.lua: ArduPlane flies past what goe_companion has found. SPDX-License-Identifier: MIT

The companion (reaction mode "off", reports on) sends GOE_HAZARD for each obstacle and GOE_STATUS once a second. An obstacle with
an order makes this script fly to the order's target in GUIDED, and back into the mode before when the obstacle is passed. Only
from AUTO and CRUISE; GO_AROUND only while landing in AUTO. Whoever chooses another mode meanwhile is not fought.

Passed is an obstacle that the companion still reports, without an order any more. If it was given up, after HOLD, or if the
companion falls silent, the aircraft stays at the target, circling, and the pilot is told: what is not seen may lie ahead.

The firmware's dialect need not know the messages: ArduPilot 4.7-dev hands scripts what its parser does not know. A link's
signatures are then not checked; only messages of the own system id are taken.
]]

local HAZARD = { id = 42702, crc_extra = 114, length = 67 }
local STATUS = { id = 42703, crc_extra = 89, length = 32 }
local ORDER_FLAG = 0x20
local LEFT, RIGHT, CLIMB, GO_AROUND = 1, 2, 3, 4
local AUTO, CRUISE, GUIDED = 10, 7, 15
local DO_GO_AROUND = 191
local NOTHING_KNOWN = 2147483647 -- of latitudes and longitudes
local HEADER = 12                -- bytes of the message as scripts get it, before its payload
local PERIOD_MS = 100
local SILENCE_MS = 3000          -- a link may lose two GOE_STATUS
local RENEW_MS = 1000            -- the target moves as the estimate does
local TEXT_WARNING, TEXT_INFO = 4, 6

local PREFIX = "GOEP_"
assert(param:add_table(187, PREFIX, 1), "goe: no table of parameters")
assert(param:add_param(187, 1, "ENABLE", 1), "goe: no parameter")
local enable = Parameter(PREFIX .. "ENABLE")

local own_system = param:get("MAV_SYSID") or param:get("SYSID_THISMAV") or 1

local mode_before -- while this script has changed the mode
local overruled = false
local standing -- the order: whose, action, lat, lon, down; is_past: that one is reported without an order; over_ms: since then
-- the companion gives none
local heard_ms = uint32_t(0)
local sent_ms = uint32_t(0)
local silence_told = false

local function say(severity, text)
    gcs:send_text(severity, "GOE: " .. text)
end

local function checksum(bytes)
    local crc = 0xFFFF
    for i = 1, #bytes do
        local x = bytes:byte(i) ~ (crc & 0xFF)
        x = (x ~ (x << 4)) & 0xFF
        crc = ((crc >> 8) ~ (x << 8) ~ (x << 3) ~ (x >> 4)) & 0xFFFF
    end
    return crc
end

-- The payload of a whole message of that kind from the own system, with the zeros that the wire leaves out; nil: it is none.
local function payload_of(message, kind)
    local crc, _, length = string.unpack("<HBB", message)
    if length > kind.length or string.unpack("<B", message, 8) ~= own_system then
        return nil
    end
    if checksum(message:sub(4, HEADER + length) .. string.char(kind.crc_extra)) ~= crc then
        return nil
    end
    return message:sub(HEADER + 1, HEADER + length) .. string.rep("\0", kind.length - length)
end

local function id_of(message)
    return (string.unpack("<I3", message, 10))
end

local function take_hazard(payload)
    local lat, lon, _, _, down = string.unpack("<i4i4fff", payload, 13)
    local action, flags = string.unpack("<BB", payload, 66)
    local whose = payload:sub(9, 12) .. payload:sub(65, 65) -- number and place in the table
    if flags & ORDER_FLAG == 0 or action == 0 then
        if standing and standing.whose == whose then
            standing.is_past = true
        end
        return
    end
    if action ~= GO_AROUND and (lat == NOTHING_KNOWN or lon == NOTHING_KNOWN or down ~= down) then
        return
    end
    standing = { whose = whose, action = action, lat = lat, lon = lon, down = down }
end

local function take_status(payload)
    if not standing then
        return
    elseif string.unpack("<B", payload, 30) ~= 0 then
        standing.over_ms = nil
    elseif not standing.over_ms then
        standing.over_ms = millis()
    end
end

local function receive()
    while true do
        local message = mavlink:receive_chan()
        if not message then
            return
        end
        local kind = id_of(message) == HAZARD.id and HAZARD or STATUS
        local payload = payload_of(message, kind)
        if payload then
            heard_ms = millis()
            if kind == HAZARD then
                take_hazard(payload)
            else
                take_status(payload)
            end
        end
    end
end

local function fly_to_target()
    local place = ahrs:get_origin()
    if not place then
        return
    end
    place:alt(place:alt() - math.floor(100 * standing.down))
    place:lat(standing.lat)
    place:lng(standing.lon)
    if vehicle:set_target_location(place) then
        sent_ms = millis()
    end
end

local function go_around()
    if vehicle:get_mode() == AUTO and vehicle:is_landing() then
        say(TEXT_WARNING, "go around")
        gcs:run_command_int(DO_GO_AROUND, {})
    end
    overruled = true -- once; the landing sequence goes on from there
end

local function begin_order()
    local mode = vehicle:get_mode()
    if standing.action == GO_AROUND then
        go_around()
    elseif (mode == AUTO or mode == CRUISE) and not vehicle:is_landing() and not vehicle:is_taking_off() and
        vehicle:set_mode(GUIDED) then
        mode_before = mode
        say(TEXT_WARNING, "flying past an obstacle")
        fly_to_target()
    end
end

local function follow_order()
    if overruled then
        return
    end
    if not mode_before then
        begin_order()
    elseif vehicle:get_mode() ~= GUIDED then
        mode_before = nil
        overruled = true
        say(TEXT_INFO, "left to whoever chose the mode")
    elseif standing.action == GO_AROUND then
        return
    elseif millis() - sent_ms > RENEW_MS then
        fly_to_target()
    end
end

local function is_passed()
    local action = standing.action
    return standing.is_past and (action == LEFT or action == RIGHT or action == CLIMB)
end

local function end_order()
    if mode_before and vehicle:get_mode() == GUIDED then
        if is_passed() then
            say(TEXT_INFO, "past it")
            vehicle:set_mode(mode_before)
        else
            say(TEXT_WARNING, "not surely past, circling: pilot to decide")
        end
    end
    standing, mode_before, overruled = nil, nil, false
end

-- Its report without an order may come after the word that there is none.
local function is_over()
    return standing.over_ms and
        (standing.is_past or not mode_before or millis() - standing.over_ms > SILENCE_MS)
end

-- An order stands on, at its target, while nothing is heard.
local function watch_silence()
    local silent = millis() - heard_ms > SILENCE_MS
    if silent and mode_before and not silence_told then
        say(TEXT_WARNING, "companion silent, circling: pilot to decide")
    end
    silence_told = silent and mode_before ~= nil
    return silent
end

local function update()
    receive()
    if enable:get() < 1 or not arming:is_armed() then
        standing, mode_before, overruled = nil, nil, false
    elseif standing then
        local silent = watch_silence()
        if is_over() then
            end_order()
        elseif silent and not mode_before then
            standing = nil
        elseif not standing.over_ms then
            follow_order()
        end
    end
    return update, PERIOD_MS
end

mavlink:init(20, 2)
mavlink:register_rx_msgid(HAZARD.id)
mavlink:register_rx_msgid(STATUS.id)
say(TEXT_INFO, "script runs")

return update()
