/* Bytes to and from somewhere. SPDX-License-Identifier: MIT */
#include "link.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#define WHERE_MAX 512
#define MEND_US 1000000
#define REST_MAX 512
#define DEAD_AFTER_MS 3000 /* a TCP peer that acknowledges nothing for so long is lost */
#define DATAGRAM_TRIES 2
#define RECEIVE_BUFFER 1048576 /* bytes of a UDP socket: a second of everything */

typedef enum { LINK_UDP_IN, LINK_UDP_OUT, LINK_TCP, LINK_SERIAL, LINK_FIFO, LINK_STDIN } link_kind_t;

struct link {
    link_kind_t kind;
    char host[WHERE_MAX], service[32]; /* host or path; port or baud rate */
    int descriptor;                    /* -1: not open */
    bool connecting, ended;
    bool bound; /* udpin: the system refuses whoever is not the peer */
    unsigned losses;
    int64_t tried_us;
    struct addrinfo *addresses, *next;  /* of the host, resolved once; the one to be tried next */
    struct sockaddr_storage from, peer; /* sender of the latest datagram; to whom answers go */
    socklen_t from_size, peer_size;     /* 0: none */
    uint8_t rest[REST_MAX];             /* of a stream: what of the latest write did not go out yet */
    size_t rest_size;
};

/* ---------------------------------------------------------------------------------------------------------- where -- */

static const struct {
    const char *scheme;
    link_kind_t kind;
    int parts; /* behind the scheme */
} schemes[] = {
    {"udpin", LINK_UDP_IN, 2}, {"udp", LINK_UDP_IN, 2},    {"udpout", LINK_UDP_OUT, 2}, {"tcp", LINK_TCP, 2},
    {"fifo", LINK_FIFO, 1},    {"serial", LINK_SERIAL, 2}, {"stdin", LINK_STDIN, 0},
};
#define SCHEMES (sizeof schemes / sizeof schemes[0])

/* "rest" = host:service, split at the last colon, as IPv6 addresses have some of their own. */
static bool split(link_t *link, const char *rest, int parts) {
    const char *colon = strrchr(rest, ':');
    if (parts < 2) {
        (void)snprintf(link->host, sizeof link->host, "%s", rest);
        return parts == 0 || *rest != '\0';
    }
    if (colon == NULL || colon == rest || colon[1] == '\0' || strlen(colon + 1) >= sizeof link->service) {
        return false;
    }
    (void)snprintf(link->host, sizeof link->host, "%.*s", (int)(colon - rest), rest);
    (void)snprintf(link->service, sizeof link->service, "%s", colon + 1);
    return true;
}

static bool parse_where(link_t *link, const char *where) {
    const size_t length = strcspn(where, ":");
    for (size_t i = 0; i < SCHEMES; i++) {
        if (strlen(schemes[i].scheme) == length && strncmp(schemes[i].scheme, where, length) == 0) {
            const bool has_rest = where[length] == ':';
            link->kind = schemes[i].kind;
            return has_rest == (schemes[i].parts > 0) &&
                   split(link, has_rest ? where + length + 1 : "", schemes[i].parts);
        }
    }
    return false;
}

/* ----------------------------------------------------------------------------------------------------------- open -- */

static void set_nonblocking(int descriptor) {
    const int flags = fcntl(descriptor, F_GETFL, 0);
    (void)fcntl(descriptor, F_SETFL, flags | O_NONBLOCK);
    (void)fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

/* Frames are small and must not wait for each other; nothing else reveals a peer that was cut off. */
static void set_tcp(int descriptor) {
    const int on = 1, dead_after_ms = DEAD_AFTER_MS;
    (void)setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
#ifdef TCP_USER_TIMEOUT
    (void)setsockopt(descriptor, IPPROTO_TCP, TCP_USER_TIMEOUT, &dead_after_ms, sizeof dead_after_ms);
#else
    (void)dead_after_ms;
#endif
}

/* A socket on or towards an address. -1: errno, or the resolver's text in *why. */
static int open_address(link_t *link, const struct addrinfo *address) {
    const int descriptor = socket(address->ai_family, address->ai_socktype, address->ai_protocol);
    const int size = RECEIVE_BUFFER;
    if (descriptor < 0) {
        return -1;
    }
    set_nonblocking(descriptor);
    (void)setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
    if (link->kind == LINK_TCP) {
        set_tcp(descriptor);
    }
    if (link->kind == LINK_UDP_IN) {
        if (bind(descriptor, address->ai_addr, address->ai_addrlen) == 0) {
            return descriptor;
        }
    } else if (link->kind == LINK_UDP_OUT) {
        if (connect(descriptor, address->ai_addr, address->ai_addrlen) == 0) { /* the system refuses strangers */
            return descriptor;
        }
    } else if (connect(descriptor, address->ai_addr, address->ai_addrlen) == 0 || errno == EINPROGRESS) {
        link->connecting = true;
        return descriptor;
    }
    const int why = errno;
    (void)close(descriptor);
    errno = why;
    return -1;
}

static bool resolve(link_t *link, const char **why) {
    struct addrinfo hints;
    (void)memset(&hints, 0, sizeof hints);
    hints.ai_socktype = link->kind == LINK_TCP ? SOCK_STREAM : SOCK_DGRAM;
    hints.ai_flags = link->kind == LINK_UDP_IN ? AI_PASSIVE : 0;
    const int result = getaddrinfo(link->host, link->service, &hints, &link->addresses);
    if (result != 0) {
        link->addresses = NULL;
        *why = gai_strerror(result);
    }
    return result == 0;
}

/* The next of the host's addresses, in turn. */
static int open_socket(link_t *link, const char **why) {
    if (link->addresses == NULL && !resolve(link, why)) {
        return -1;
    }
    const struct addrinfo *address = link->next != NULL ? link->next : link->addresses;
    if (address == NULL) {
        *why = "no address";
        return -1;
    }
    const int descriptor = open_address(link, address);
    if (descriptor < 0) {
        *why = strerror(errno);
    }
    link->next = address->ai_next;
    return descriptor;
}

static const struct {
    const char *text;
    speed_t speed;
} rates[] = {{"9600", B9600},      {"19200", B19200},     {"38400", B38400},     {"57600", B57600},
             {"115200", B115200},  {"230400", B230400},   {"460800", B460800},   {"500000", B500000},
             {"921600", B921600},  {"1000000", B1000000}, {"1500000", B1500000}, {"2000000", B2000000},
             {"3000000", B3000000}};
#define RATES (sizeof rates / sizeof rates[0])

static bool find_rate(const char *text, speed_t *speed) {
    for (size_t i = 0; i < RATES; i++) {
        if (strcmp(rates[i].text, text) == 0) {
            *speed = rates[i].speed;
            return true;
        }
    }
    return false;
}

/* -1: *why says why not. */
static int open_path(const char *path, int flags, const char **why) {
    const int descriptor = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC | flags);
    if (descriptor < 0) {
        *why = strerror(errno);
    }
    return descriptor;
}

static int open_serial(const link_t *link, const char **why) {
    struct termios settings;
    speed_t speed = B0;
    const int descriptor = open_path(link->host, O_NOCTTY, why);
    if (descriptor < 0) {
        return -1;
    }
    if (tcgetattr(descriptor, &settings) == 0 && find_rate(link->service, &speed)) {
        cfmakeraw(&settings);
        settings.c_cflag |= (tcflag_t)(CLOCAL | CREAD);
        settings.c_cflag &= ~(tcflag_t)(CRTSCTS | CSTOPB);
        (void)cfsetispeed(&settings, speed);
        (void)cfsetospeed(&settings, speed);
        (void)tcsetattr(descriptor, TCSANOW, &settings);
    }
    return descriptor;
}

/* Opened for writing too: so it has no end when its last writer leaves. */
static int open_fifo(const link_t *link, const char **why) {
    const int descriptor = open_path(link->host, 0, why);
    struct stat about;
    if (descriptor >= 0 && (fstat(descriptor, &about) != 0 || !S_ISFIFO(about.st_mode))) {
        (void)close(descriptor);
        *why = "is no FIFO; make it by mkfifo";
        return -1;
    }
    return descriptor;
}

static bool open_now(link_t *link, const char **why) {
    switch (link->kind) {
        case LINK_SERIAL:
            link->descriptor = open_serial(link, why);
            break;
        case LINK_FIFO:
            link->descriptor = open_fifo(link, why);
            break;
        case LINK_STDIN:
            link->descriptor = STDIN_FILENO; /* left blocking: a terminal would give standard output the same flag */
            break;
        case LINK_UDP_IN:
        case LINK_UDP_OUT:
        case LINK_TCP:
        default:
            link->descriptor = open_socket(link, why);
            break;
    }
    return link->descriptor >= 0;
}

/* A temporary fault is waited out; a permanent one is a failure. */
static bool may_come(const link_t *link) { return link->kind == LINK_TCP || link->kind == LINK_SERIAL; }

static bool is_port(const char *text) {
    char *end = NULL;
    const long port = strtol(text, &end, 10);
    return *text >= '0' && *text <= '9' && *end == '\0' && port > 0 && port <= 65535;
}

/* Null: all is well. */
static const char *wrong_form(link_t *link, const char *where) {
    speed_t speed = B0;
    if (!parse_where(link, where)) {
        return "not of the form udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT, serial:DEVICE:BAUD, fifo:PATH or "
               "stdin";
    }
    if (link->kind == LINK_SERIAL) {
        return find_rate(link->service, &speed) ? NULL : "no usual baud rate";
    }
    const bool has_port = link->kind == LINK_TCP || link->kind == LINK_UDP_IN || link->kind == LINK_UDP_OUT;
    return has_port && !is_port(link->service) ? "a port is 1 to 65535" : NULL;
}

bool link_check(const char *where, char *fault, size_t fault_size) {
    link_t link;
    (void)memset(&link, 0, sizeof link);
    const char *why = wrong_form(&link, where);
    if (why != NULL) {
        (void)snprintf(fault, fault_size, "%s: %s", where, why);
    }
    return why == NULL;
}

/* Whether `where` waits on one of these hosts. */
static bool waits_on(const char *where, const char *one, const char *other) {
    link_t link;
    (void)memset(&link, 0, sizeof link);
    return parse_where(&link, where) && link.kind == LINK_UDP_IN &&
           (strcmp(link.host, one) == 0 || strcmp(link.host, other) == 0);
}

bool link_is_wide(const char *where) { return waits_on(where, "0.0.0.0", "::"); }
bool link_is_local(const char *where) { return waits_on(where, "127.0.0.1", "::1"); }

link_t *link_open(const char *where, char *fault, size_t fault_size) {
    link_t *link = calloc(1, sizeof *link);
    const char *why = "out of memory";
    if (link != NULL) {
        link->descriptor = -1;
        why = wrong_form(link, where);
        if (why == NULL && (open_now(link, &why) || may_come(link))) {
            return link;
        }
    }
    (void)snprintf(fault, fault_size, "%s: %s", where, why);
    free(link);
    return NULL;
}

int link_descriptor(const link_t *link) { return link->descriptor; }
bool link_has_messages(const link_t *link) { return link->kind == LINK_UDP_IN || link->kind == LINK_UDP_OUT; }
unsigned link_losses(const link_t *link) { return link->losses; }
bool link_ended(const link_t *link) { return link->ended; }

/* --------------------------------------------------------------------------------------------------- read and write -- */

static void lose(link_t *link) {
    if (link->kind == LINK_STDIN) {
        link->ended = true;
    } else {
        (void)close(link->descriptor);
        link->losses++;
    }
    link->rest_size = 0;
    link->descriptor = -1;
}

static bool is_for_later(int why) { return why == EAGAIN || why == EINTR || why == EINPROGRESS; }

static bool has_bytes(const link_t *link) {
    struct pollfd request = {.fd = link->descriptor, .events = POLLIN, .revents = 0};
    return poll(&request, 1, 0) > 0;
}

size_t link_read(link_t *link, uint8_t *bytes, size_t size) {
    ssize_t got = 0;
    if (link->descriptor < 0 || (link->kind == LINK_STDIN && !has_bytes(link))) {
        return 0;
    }
    if (link_has_messages(link)) {
        link->from_size = sizeof link->from;
        got = recvfrom(link->descriptor, bytes, size, 0, (struct sockaddr *)&link->from, &link->from_size);
        return got > 0 ? (size_t)got : 0; /* what a peer refuses is its affair */
    }
    got = read(link->descriptor, bytes, size);
    if (got == 0 || (got < 0 && !is_for_later(errno) && !(link->connecting && errno == ENOTCONN))) {
        lose(link);
    }
    link->connecting = link->connecting && got < 0;
    return got > 0 ? (size_t)got : 0;
}

void link_answer(link_t *link) {
    if (link->kind != LINK_UDP_IN || link->from_size == 0 || (link->bound && link_is_answered(link))) {
        return;
    }
    link->peer = link->from;
    link->peer_size = link->from_size;
    link->bound = connect(link->descriptor, (const struct sockaddr *)&link->peer, link->peer_size) == 0;
}

void link_greet(link_t *link) {
    if (link->kind == LINK_UDP_IN && !link->bound) {
        link->peer = link->from;
        link->peer_size = link->from_size;
    }
}

void link_release(link_t *link) {
    struct sockaddr nobody;
    (void)memset(&nobody, 0, sizeof nobody);
    nobody.sa_family = AF_UNSPEC;
    if (link->bound) {
        link->bound = connect(link->descriptor, &nobody, sizeof nobody) != 0;
    }
}

bool link_is_answered(const link_t *link) {
    return link->kind != LINK_UDP_IN || link->peer_size == 0 ||
           (link->from_size == link->peer_size && memcmp(&link->from, &link->peer, link->peer_size) == 0);
}

/* How much of it goes out now. */
static size_t write_some(link_t *link, const uint8_t *bytes, size_t size) {
    const ssize_t sent = link->kind == LINK_TCP ? send(link->descriptor, bytes, size, MSG_NOSIGNAL)
                                                : write(link->descriptor, bytes, size);
    if (sent < 0 && !is_for_later(errno) && errno != ENOTCONN) {
        lose(link);
    }
    return sent > 0 ? (size_t)sent : 0;
}

/* A frame that went out in part is finished before the next one: half of it would take that along. */
static bool write_stream(link_t *link, const uint8_t *bytes, size_t size) {
    if (link->rest_size > 0) {
        const size_t sent = write_some(link, link->rest, link->rest_size);
        link->rest_size -= sent <= link->rest_size ? sent : link->rest_size;
        (void)memmove(link->rest, link->rest + sent, link->rest_size);
        if (link->rest_size > 0 || link->descriptor < 0) {
            return false;
        }
    }
    const size_t sent = write_some(link, bytes, size);
    if (sent > 0 && sent < size && size - sent <= sizeof link->rest) {
        link->rest_size = size - sent;
        (void)memcpy(link->rest, bytes + sent, link->rest_size);
        return true;
    }
    return sent == size;
}

/* What an earlier datagram met, such as a port that nobody listened to, is reported once, and takes nothing from this one. */
static bool write_datagram(link_t *link, const uint8_t *bytes, size_t size) {
    for (int i = 0; i < DATAGRAM_TRIES; i++) {
        const bool known = link->kind == LINK_UDP_OUT || link->bound;
        const struct sockaddr *peer = known ? NULL : (const struct sockaddr *)&link->peer;
        const socklen_t peer_size = known ? 0 : link->peer_size;
        if ((known || peer_size > 0) &&
            sendto(link->descriptor, bytes, size, MSG_NOSIGNAL, peer, peer_size) == (ssize_t)size) {
            return true;
        }
    }
    return false;
}

bool link_write(link_t *link, const uint8_t *bytes, size_t size) {
    if (link->descriptor < 0) {
        return false;
    }
    if (!link_has_messages(link)) {
        return write_stream(link, bytes, size);
    }
    return write_datagram(link, bytes, size);
}

void link_mend(link_t *link, int64_t now_us) {
    const char *why = NULL;
    if (link->descriptor < 0 && !link->ended && now_us - link->tried_us >= MEND_US) {
        link->tried_us = now_us;
        (void)open_now(link, &why);
    }
}

void link_close(link_t *link) {
    if (link != NULL && link->descriptor >= 0 && link->kind != LINK_STDIN) {
        (void)close(link->descriptor);
    }
    if (link != NULL && link->addresses != NULL) {
        freeaddrinfo(link->addresses);
    }
    free(link);
}
