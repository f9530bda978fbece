/* A socket of the test that receives what a part of the companion sends. SPDX-License-Identifier: MIT */
#ifndef RECEIVER_H
#define RECEIVER_H

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "check.h"
#include "wire.h"

typedef struct {
    int socket;
    uint8_t bytes[512];
    ssize_t size, next; /* of the current datagram */
} receiver_t;

/* Opens a socket on loopback and writes its port to *port. */
static inline int receiver_socket(int *port) {
    struct sockaddr_in address;
    socklen_t size = sizeof address;
    (void)memset(&address, 0, sizeof address);
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int made = socket(AF_INET, SOCK_DGRAM, 0);
    TEST_ASSERT_EQUAL_INT(0, bind(made, (struct sockaddr *)&address, sizeof address));
    TEST_ASSERT_EQUAL_INT(0, getsockname(made, (struct sockaddr *)&address, &size));
    *port = ntohs(address.sin_port);
    return made;
}

static inline void receiver_open(receiver_t *receiver, wire_t *wire) {
    char where[64], fault[128];
    int port = 0;
    (void)memset(receiver, 0, sizeof *receiver);
    receiver->socket = receiver_socket(&port);
    (void)snprintf(where, sizeof where, "udpout:127.0.0.1:%d", port);
    wire->link = link_open(where, fault, sizeof fault);
    TEST_ASSERT_NOT_NULL_MESSAGE(wire->link, fault);
    wire->system = 1;
    wire->component = 196;
    wire->autopilot_system = 1;
}

static inline void receiver_close(receiver_t *receiver, wire_t *wire) {
    link_close(wire->link);
    (void)close(receiver->socket);
}

/* The next message; false: none has arrived. */
static inline bool receiver_next(receiver_t *receiver, mavlink_message_t *message) {
    mavlink_status_t status;
    for (;;) {
        while (receiver->next < receiver->size) {
            const uint8_t byte = receiver->bytes[receiver->next];
            receiver->next++;
            if (mavlink_parse_char(MAVLINK_COMM_1, byte, message, &status) != 0) {
                return true;
            }
        }
        receiver->size = recv(receiver->socket, receiver->bytes, sizeof receiver->bytes, MSG_DONTWAIT);
        receiver->next = 0;
        if (receiver->size <= 0) {
            return false;
        }
    }
}

#endif
