/* Senders that a link accepts, and the time of signatures. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "receiver.h"
#include "signing.h"

#define TICKS_PER_S UINT64_C(100000)
#define UNIX_US INT64_C(1790000000000000)
#define NOW_TICKS ((uint64_t)(UNIX_US - INT64_C(1420070400000000)) / 10u)

static char folder[] = "/tmp/goe_links_XXXXXX";
static char key_path[64], time_path[80];
static int friend_socket, stranger_socket, own_port;
static link_t *own;

void setUp(void) {
    char where[64], fault[128];
    int port = 0;
    const int probe = receiver_socket(&own_port); /* a free port */
    (void)close(probe);
    friend_socket = receiver_socket(&port);
    stranger_socket = receiver_socket(&port);
    (void)snprintf(where, sizeof where, "udpin:127.0.0.1:%d", own_port);
    own = link_open(where, fault, sizeof fault);
    TEST_ASSERT_NOT_NULL_MESSAGE(own, fault);
    (void)remove(time_path);
}

void tearDown(void) {
    link_close(own);
    (void)close(friend_socket);
    (void)close(stranger_socket);
}

static void send_from(int from, char what) {
    struct sockaddr_in to;
    (void)memset(&to, 0, sizeof to);
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons((uint16_t)own_port);
    (void)sendto(from, &what, 1, 0, (struct sockaddr *)&to, sizeof to);
}

/* The next message; 0: none. */
static char heard(void) {
    uint8_t bytes[16];
    return link_read(own, bytes, sizeof bytes) == 1 ? (char)bytes[0] : '\0';
}

static bool is_answered_at(int where) {
    uint8_t byte = 0;
    (void)link_write(own, (const uint8_t *)"!", 1);
    return recv(where, &byte, 1, MSG_DONTWAIT) == 1;
}

static void once_answered_the_system_refuses_strangers(void) {
    send_from(stranger_socket, 's');
    send_from(friend_socket, 'f');
    TEST_ASSERT_EQUAL_CHAR('s', heard());
    TEST_ASSERT_EQUAL_CHAR('f', heard());
    link_answer(own);
    TEST_ASSERT_TRUE(is_answered_at(friend_socket));
    send_from(stranger_socket, 's');
    TEST_ASSERT_EQUAL_CHAR('\0', heard());
    send_from(friend_socket, 'f');
    TEST_ASSERT_EQUAL_CHAR('f', heard());
    TEST_ASSERT_TRUE(link_is_answered(own));
}

static void what_lay_there_before_is_known_as_a_strangers(void) {
    send_from(friend_socket, 'f');
    send_from(stranger_socket, 's');
    TEST_ASSERT_EQUAL_CHAR('f', heard());
    link_answer(own);
    TEST_ASSERT_EQUAL_CHAR('s', heard());
    TEST_ASSERT_FALSE(link_is_answered(own));
}

static void a_link_that_is_released_hears_everybody_again(void) {
    send_from(friend_socket, 'f');
    (void)heard();
    link_answer(own);
    link_release(own);
    TEST_ASSERT_TRUE(is_answered_at(friend_socket));
    send_from(stranger_socket, 's');
    TEST_ASSERT_EQUAL_CHAR('s', heard());
    link_answer(own);
    TEST_ASSERT_TRUE(is_answered_at(stranger_socket));
    send_from(friend_socket, 'f');
    TEST_ASSERT_EQUAL_CHAR('\0', heard());
}

static void who_is_greeted_is_answered_and_not_alone_heard(void) {
    send_from(friend_socket, 'f');
    (void)heard();
    link_greet(own);
    TEST_ASSERT_TRUE(is_answered_at(friend_socket));
    send_from(stranger_socket, 's');
    TEST_ASSERT_EQUAL_CHAR('s', heard());
    link_answer(own);
    send_from(stranger_socket, 's');
    (void)heard();
    link_greet(own);
    TEST_ASSERT_FALSE(is_answered_at(friend_socket));
}

/* ---------------------------------------------------------------------------------------------------------- signing -- */

static uint64_t kept(void) {
    char text[32] = "0";
    FILE *file = fopen(time_path, "r");
    if (file != NULL) {
        TEST_ASSERT_NOT_NULL(fgets(text, sizeof text, file));
        (void)fclose(file);
    }
    return strtoull(text, NULL, 10);
}

static uint64_t begin(signing_t *signing, int64_t unix_us) {
    static wire_t wire;
    const uint8_t key[KEY_BYTES] = {1, 2, 3};
    (void)memset(&wire, 0, sizeof wire);
    signing_begin(signing, &wire, key_path, key, unix_us);
    return signing->state.timestamp;
}

static void pass_over(void *user, const mavlink_message_t *message) {
    (void)user;
    (void)message;
}

/* Its checksum is unknown, and the parser reports that before it has read the signature: half a frame. */
static void a_signed_message_of_an_unknown_kind_counts_once(void) {
    static wire_t wire;
    uint8_t frame[MAVLINK_NUM_HEADER_BYTES + 1u + 2u + MAVLINK_SIGNATURE_BLOCK_LEN] = {
        MAVLINK_STX, 1, MAVLINK_IFLAG_SIGNED, 0, 0, 1, MAV_COMP_ID_AUTOPILOT1, 0xFF, 0xFF, 0x7F, 'x'};
    struct sockaddr_in to;
    (void)memset(&to, 0, sizeof to);
    (void)memset(&wire, 0, sizeof wire);
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons((uint16_t)own_port);
    wire.link = own;
    wire.autopilot_system = 1;
    for (uint8_t number = 0; number < 3; number++) {
        frame[4] = number;
        (void)sendto(friend_socket, frame, sizeof frame, 0, (struct sockaddr *)&to, sizeof to);
    }
    while (wire_receive(&wire, pass_over, NULL)) {
    }
    TEST_ASSERT_EQUAL_UINT32(3, (uint32_t)wire.counts.unknown);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)(wire.counts.garbage + wire.counts.lost + wire.counts.messages));
}

static void times_of_signatures_never_go_back(void) {
    signing_t signing;
    wire_t wire;
    (void)memset(&wire, 0, sizeof wire);
    TEST_ASSERT_EQUAL_UINT64(NOW_TICKS, begin(&signing, UNIX_US));
    TEST_ASSERT_TRUE(kept() > NOW_TICKS);
    TEST_ASSERT_TRUE(kept() < NOW_TICKS + 60u * TICKS_PER_S); /* a receiver allows a minute */
    for (int64_t second = 1; second <= 100; second++) {
        signing_go_on(&signing, &wire, UNIX_US + second * 1000000);
        TEST_ASSERT_EQUAL_UINT64(NOW_TICKS + (uint64_t)second * TICKS_PER_S, signing.state.timestamp);
        TEST_ASSERT_TRUE(kept() > signing.state.timestamp + 2u * TICKS_PER_S);
    }
    const uint64_t latest = signing.state.timestamp;
    signing_go_on(&signing, &wire, UNIX_US - 1000000); /* the clock is set back */
    TEST_ASSERT_EQUAL_UINT64(latest, signing.state.timestamp);
    TEST_ASSERT_TRUE(begin(&signing, 0) > latest);
    TEST_ASSERT_EQUAL_UINT64(NOW_TICKS + 500u * TICKS_PER_S, begin(&signing, UNIX_US + 500000000));
}

static void a_time_that_is_none_is_passed_over(void) {
    signing_t signing;
    FILE *file = fopen(time_path, "w");
    TEST_ASSERT_NOT_NULL(file);
    (void)fputs("99999999999999999999999\n", file);
    (void)fclose(file);
    TEST_ASSERT_EQUAL_UINT64(NOW_TICKS, begin(&signing, UNIX_US));
}

/* A new file in its place might be empty after a loss of power. */
static void a_kept_time_takes_the_place_of_the_old_one_in_its_file(void) {
    signing_t signing;
    wire_t wire;
    struct stat before, after;
    char line[64] = "";
    const uint8_t key[KEY_BYTES] = {0};
    (void)memset(&wire, 0, sizeof wire);
    signing_begin(&signing, &wire, key_path, key, UNIX_US);
    TEST_ASSERT_EQUAL_INT(0, stat(time_path, &before));
    signing_go_on(&signing, &wire, UNIX_US + 30000000);
    TEST_ASSERT_EQUAL_INT(0, stat(time_path, &after));
    TEST_ASSERT_TRUE(before.st_ino == after.st_ino && before.st_size == after.st_size);
    FILE *file = fopen(time_path, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, file));
    (void)fclose(file);
    TEST_ASSERT_TRUE(strtoull(line, NULL, 10) >= NOW_TICKS + 30u * TICKS_PER_S);
}

static void a_time_that_cannot_be_kept_blocks_nothing(void) {
    signing_t signing;
    wire_t wire;
    const uint8_t key[KEY_BYTES] = {0};
    (void)memset(&wire, 0, sizeof wire);
    signing_begin(&signing, &wire, "/nowhere/link.key", key, UNIX_US);
    TEST_ASSERT_TRUE(signing.on && signing.failed);
    signing_go_on(&signing, &wire, UNIX_US + 1000000);
    TEST_ASSERT_EQUAL_UINT64(NOW_TICKS + TICKS_PER_S, signing.state.timestamp);
}

int main(void) {
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    (void)snprintf(key_path, sizeof key_path, "%s/link.key", folder);
    (void)snprintf(time_path, sizeof time_path, "%s.time", key_path);
    UNITY_BEGIN();
    RUN_TEST(once_answered_the_system_refuses_strangers);
    RUN_TEST(what_lay_there_before_is_known_as_a_strangers);
    RUN_TEST(a_link_that_is_released_hears_everybody_again);
    RUN_TEST(who_is_greeted_is_answered_and_not_alone_heard);
    RUN_TEST(a_signed_message_of_an_unknown_kind_counts_once);
    RUN_TEST(times_of_signatures_never_go_back);
    RUN_TEST(a_time_that_is_none_is_passed_over);
    RUN_TEST(a_kept_time_takes_the_place_of_the_old_one_in_its_file);
    RUN_TEST(a_time_that_cannot_be_kept_blocks_nothing);
    (void)remove(time_path);
    (void)rmdir(folder);
    return UNITY_END();
}
