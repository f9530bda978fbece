/* Implements the stand-in headers. SPDX-License-Identifier: MIT */
#include "scripted.h"

#include <unity.h>

#include <AP_GOE.h>

#include <AP_Arming/AP_Arming.h>
#include <AP_HAL/AP_HAL.h>
#include <AP_InertialSensor/AP_InertialSensor.h>
#include <AP_Logger/AP_Logger.h>
#include <AP_Param/AP_Param.h>
#include <AP_Terrain/AP_Terrain.h>
#include <AP_Vehicle/AP_Vehicle.h>

#include <atomic>
#include <condition_variable>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <sstream>
#include <thread>

Scripted scripted;

Scripted::Scripted()
    : now_us(1000000), sample_us(1000000), has_position(true), has_nav(true), home_set(true), origin_known(true),
      down_of_home(0.0f), origin{48800, 473977420, 85455940}, ekf_type(3), core(0), yaw_reset_ms(0),
      horizontal_reset_ms(0), vertical_reset_ms(0), vertical_change(0.0f), has_range_finder(false), has_terrain(false),
      range_finder(RangeFinder::Status::Good), range_m(0.0f), terrain_m(0.0f), armed(false), landing(false),
      has_memory(true), has_threads(true), has_database(true), thread_is_late(false), runs_at_once(false), channel(1),
      active(1, true), is_private(1, false), txspace(1000), allocations(0), thread_stack(0), wakes(0), searches(0) {
    channel[0] = mavlink_status_t{0, nullptr};
}

bool Scripted::has_said(const char *part) const {
    for (const std::string &text : texts) {
        if (text.find(part) != std::string::npos) {
            return true;
        }
    }
    return false;
}

std::map<uint32_t, AP_OADatabase::OA_DbItem> Scripted::database() const {
    std::map<uint32_t, AP_OADatabase::OA_DbItem> found;
    AP_OADatabase *const database = AP::oadatabase();
    for (unsigned i = 0; database != nullptr && i < database->database_count(); i++) {
        const AP_OADatabase::OA_DbItem &item = database->get_item(i);
        if (item.source == AP_OADatabase::OA_DbItem::Source::camera) {
            found[item.id] = item;
        }
    }
    return found;
}

// --------------------------------------------------------------------------------------------------------------- HAL

static AP_HAL::Util util;
extern const AP_HAL::HAL &hal;
static AP_HAL::Scheduler scheduler;
static const AP_HAL::HAL the_hal{&scheduler, &util};
const AP_HAL::HAL &hal = the_hal;

int AP_HAL::Util::snprintf(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return length;
}

static std::atomic<uint64_t> clock_us; // the thread's view of scripted.now_us
void show_clock() { clock_us = scripted.now_us; }

static uint64_t detected_us() {
    if (!scripted.runs_at_once) {
        show_clock();
    }
    return clock_us;
}

uint32_t AP_HAL::micros() { return uint32_t(detected_us()); }
uint64_t AP_HAL::micros64() { return detected_us(); }
uint32_t AP_HAL::millis() { return uint32_t(detected_us() / 1000); }

void *operator new(size_t size, const ScriptedHeap &) noexcept {
    static std::vector<void *> &taken = *new std::vector<void *>; // locked by an object of an earlier test
    scripted.allocations++;
    taken.push_back(scripted.has_memory ? ::operator new(size, std::nothrow) : nullptr);
    return taken.back();
}

// -------------------------------------------------------------------------------------------------------------- threads

/* The thread and its waker run in turns, so that a test repeats to the last bit. A thread whose object belongs to an earlier test waits
 * for ever. */
struct ScriptedThread {
    std::mutex mutex;
    std::condition_variable changed;
    bool runs;

    void wait_for(std::unique_lock<std::mutex> &lock, bool turn) {
        changed.wait(lock, [&] { return runs == turn; });
    }
};

static ScriptedThread *latest_thread;
static thread_local ScriptedThread *own_thread;

bool AP_HAL::Scheduler::thread_create(MemberProc proc, const char *name, uint32_t stack_size, priority_base, int8_t) {
    if (!scripted.has_threads) {
        return false;
    }
    ScriptedThread *const made = new ScriptedThread{{}, {}, true};
    scripted.thread_name = name;
    scripted.thread_stack = stack_size;
    latest_thread = made;
    std::thread([=] {
        own_thread = made;
        proc();
    }).detach();
    std::unique_lock<std::mutex> lock(made->mutex);
    made->wait_for(lock, false);
    return true;
}

bool ScriptedBinarySemaphore::wait_blocking() {
    std::unique_lock<std::mutex> lock(own_thread->mutex);
    own_thread->runs = false;
    own_thread->changed.notify_all();
    own_thread->wait_for(lock, true);
    return true;
}

void ScriptedBinarySemaphore::signal() {
    std::unique_lock<std::mutex> lock(latest_thread->mutex);
    scripted.wakes++;
    if (scripted.thread_is_late) {
        return;
    }
    latest_thread->runs = true;
    latest_thread->changed.notify_all();
    if (!scripted.runs_at_once) {
        latest_thread->wait_for(lock, false);
    }
}

void wait_for_the_thread() {
    std::unique_lock<std::mutex> lock(latest_thread->mutex);
    latest_thread->wait_for(lock, false);
}

void ScriptedSemaphore::take() {
    if (scripted.runs_at_once) {
        _mutex.lock();
    } else if (!_mutex.try_lock()) {
        abort();
    }
}

void ScriptedSemaphore::give() { _mutex.unlock(); }

// ----------------------------------------------------------------------------------------------------------- parameters

static std::map<const AP_Param *, std::string> &names() {
    static std::map<const AP_Param *, std::string> the_names;
    return the_names;
}

/* A search by name through all parameters is slow, and is counted. */
AP_Param *AP_Param::find(const char *name, enum ap_var_type *type, uint16_t *) {
    static AP_Param found[8];
    scripted.searches++;
    if (scripted.parameters.count(name) == 0) {
        return nullptr;
    }
    for (AP_Param &one : found) {
        if (names()[&one].empty() || names()[&one] == name) {
            names()[&one] = name;
            *type = AP_PARAM_INT16;
            return &one;
        }
    }
    abort();
}

float AP_Param::cast_to_float(enum ap_var_type type) const {
    TEST_ASSERT_EQUAL(AP_PARAM_INT16, type);
    return scripted.parameters.at(names().at(this));
}

void AP_Param::setup_object_defaults(void *object, const GroupInfo *info) {
    for (; info->type != AP_PARAM_NONE; info++) {
        char *element = static_cast<char *>(object) + info->offset;
        if (info->type == AP_PARAM_FLOAT) {
            reinterpret_cast<AP_Float *>(element)->set(info->def_value);
        } else if (info->type == AP_PARAM_INT8) {
            reinterpret_cast<AP_Int8 *>(element)->set(int8_t(info->def_value));
        } else {
            reinterpret_cast<AP_Int16 *>(element)->set(int16_t(info->def_value));
        }
    }
}

// -------------------------------------------------------------------------------------------------------------- pose

namespace AP {
AP_AHRS &ahrs() {
    static AP_AHRS the_ahrs;
    return the_ahrs;
}
AP_InertialSensor &ins() {
    static AP_InertialSensor the_ins;
    return the_ins;
}
RangeFinder *rangefinder() {
    static RangeFinder the_range_finder;
    return scripted.has_range_finder ? &the_range_finder : nullptr;
}
AP_Terrain *terrain() {
    static AP_Terrain the_terrain;
    return &the_terrain;
}
} // namespace AP

void AP_AHRS::get_quat_body_to_ned(Quaternion &q) const { q = scripted.q; }
bool AP_AHRS::have_inertial_nav() const { return scripted.has_nav; }
bool AP_AHRS::home_is_set() const { return scripted.home_set; }
AP_AHRS::EKFType AP_AHRS::configured_ekf_type() const { return EKFType(scripted.ekf_type); }
int8_t AP_AHRS::get_primary_core_index() const { return scripted.core; }
void AP_AHRS::get_relative_position_D_home(float &down) const { down = scripted.position.z - scripted.down_of_home; }

bool AP_AHRS::get_relative_position_NED_origin_float(Vector3f &position) const {
    position = scripted.position;
    return scripted.has_position;
}

bool AP_AHRS::get_velocity_NED(Vector3f &velocity) const {
    velocity = scripted.velocity;
    return scripted.has_nav;
}

bool AP_AHRS::get_origin(Location &origin) const {
    origin = scripted.origin;
    return scripted.origin_known;
}

uint32_t AP_AHRS::getLastYawResetAngle(float &change) {
    change = 0.1f;
    return scripted.yaw_reset_ms;
}

uint32_t AP_AHRS::getLastPosNorthEastReset(Vector2f &change) {
    change = scripted.horizontal_change;
    return scripted.horizontal_reset_ms;
}

uint32_t AP_AHRS::getLastPosDownReset(float &change) {
    change = scripted.vertical_change;
    return scripted.vertical_reset_ms;
}

uint32_t AP_InertialSensor::get_last_update_usec() const { return scripted.sample_us; }
RangeFinder::Status RangeFinder::status_orient(enum Rotation) const { return scripted.range_finder; }
float RangeFinder::distance_orient(enum Rotation) const { return scripted.range_m; }
const Vector3f &RangeFinder::get_pos_offset_orient(enum Rotation) const { return scripted.range_finder_offset; }

bool AP_Terrain::height_above_terrain(float &height, bool) {
    height = scripted.terrain_m;
    return scripted.has_terrain;
}

// ----------------------------------------------------------------------------------------------------------- vehicle

namespace AP {
AP_Arming &arming() {
    static AP_Arming the_arming;
    return the_arming;
}
AP_Vehicle *vehicle() {
    static AP_Vehicle the_vehicle;
    return &the_vehicle;
}
AP_OADatabase *oadatabase() {
    static AP_OADatabase the_database;
    return scripted.has_database ? &the_database : nullptr;
}
AP_Logger &logger() {
    static AP_Logger the_logger;
    return the_logger;
}
} // namespace AP

bool AP_Arming::is_armed() const { return scripted.armed; }
bool AP_Vehicle::is_landing() const { return scripted.landing; }

static AP_OADatabase::OA_DbItem database_items[5]; // one of which belongs to another source

AP_OADatabase::AP_OADatabase() : _database{database_items, 0, 5}, _radius_min(0.01f), _dist_max(0.0f) {}

void AP_OADatabase::update() { AP::goe()->refresh_database(*this); }

void AP_OADatabase::database_item_add(const OA_DbItem &item) {
    if (_database.count < _database.size) {
        _database.items[_database.count] = item;
        _database.items[_database.count].send_to_gcs = get_send_to_gcs_flags(item.importance);
        _database.count++;
    }
}

uint8_t AP_OADatabase::get_send_to_gcs_flags(OA_DbItemImportance) { return 0xFF; }

void AP_OADatabase::begin(unsigned foreign) {
    _database.count = 0;
    for (unsigned i = 0; i < foreign; i++) {
        OA_DbItem item{};
        item.source = OA_DbItem::Source::AIS;
        item.id = 0x474F4500u; // the first, as AP_GOE's is
        database_item_add(item);
    }
}

void AP_OADatabase::note_sent() {
    for (uint16_t i = 0; i < _database.count; i++) {
        _database.items[i].send_to_gcs = 0;
    }
}

void AP_OADatabase::set_limits(float radius_min, float dist_max) {
    _radius_min = radius_min;
    _dist_max = dist_max;
}

/* Reads the arguments by the format: an argument of another type gives garbage, which a test detects. */
void AP_Logger::WriteStreaming(const char *name, const char *labels, const char *units, const char *mults,
                               const char *fmt, ...) {
    ScriptedRecord record{{}, units, mults, fmt, {}};
    std::stringstream words(labels);
    for (std::string label; std::getline(words, label, ',');) {
        record.labels.push_back(label);
    }
    va_list arguments;
    va_start(arguments, fmt);
    for (size_t i = 0; i < record.format.size() && i < record.labels.size(); i++) {
        double value = 0.0;
        switch (record.format[i]) {
            case 'Q':
                value = double(va_arg(arguments, uint64_t));
                break;
            case 'f':
                value = va_arg(arguments, double);
                break;
            case 'b':
                value = double(va_arg(arguments, int));
                break;
            default:
                value = double(va_arg(arguments, unsigned));
                break;
        }
        record.value[record.labels[i]] = value;
    }
    va_end(arguments);
    scripted.log[name].push_back(record);
}

// ------------------------------------------------------------------------------------------------------------- links

mavlink_system_t mavlink_system{1, 1};

mavlink_status_t *mavlink_get_channel_status(uint8_t channel) { return &scripted.channel.at(channel); }
uint16_t comm_get_txspace(mavlink_channel_t) { return scripted.txspace; }
bool GCS_MAVLINK::is_active() const { return scripted.active.at(channel); }
bool GCS_MAVLINK::is_private() const { return scripted.is_private.at(channel); }
uint8_t GCS_MAVLINK::packet_overhead_chan(mavlink_channel_t) { return 12; }
uint8_t GCS::num_gcs() const { return uint8_t(scripted.channel.size()); }

GCS &gcs() {
    static GCS the_gcs;
    return the_gcs;
}

GCS_MAVLINK *GCS::chan(uint8_t i) {
    static GCS_MAVLINK link[3];
    link[i].channel = mavlink_channel_t(i);
    return &link[i];
}

void GCS::send_text(MAV_SEVERITY, const char *format, ...) {
    char text[200];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    scripted.texts.push_back(text);
}

void _mav_finalize_message_chan_send(mavlink_channel_t channel, uint32_t msgid, const char *packet, uint8_t min_length,
                                     uint8_t length, uint8_t crc_extra) {
    scripted.sent.push_back(
        ScriptedSent{channel, msgid, std::vector<uint8_t>(packet, packet + length), min_length, crc_extra});
}
