/* System calls that newlib's printf() needs: text goes out by semihosting, floats take a small heap. For images that print; the
 * library goe needs none of them. SPDX-License-Identifier: MIT */
#include <stddef.h>

#include "semihosting.h"

#define HEAP_BYTES 8192

struct stat;

void *_sbrk(int bytes);
int _write(int file, const char *text, int length);
int _read(int file, char *text, int length);
int _close(int file);
int _fstat(int file, struct stat *status);
int _isatty(int file);
int _lseek(int file, int offset, int from);
int _kill(int process, int signal);
int _getpid(void);

void *_sbrk(int bytes) {
    static char heap[HEAP_BYTES] __attribute__((aligned(8)));
    static int used;
    if (bytes < 0 || bytes > HEAP_BYTES - used) {
        return (void *)-1;
    }
    used += bytes;
    return &heap[used - bytes];
}

int _write(int file, const char *text, int length) {
    (void)file;
    for (int i = 0; i < length; i++) {
        port_write_char(text[i]);
    }
    return length;
}

int _read(int file, char *text, int length) {
    (void)file;
    (void)text;
    (void)length;
    return 0;
}

int _close(int file) {
    (void)file;
    return -1;
}

int _fstat(int file, struct stat *status) {
    (void)file;
    (void)status;
    return -1;
}

int _isatty(int file) {
    (void)file;
    return 1;
}

int _lseek(int file, int offset, int from) {
    (void)file;
    (void)offset;
    (void)from;
    return -1;
}

int _kill(int process, int signal) {
    (void)process;
    (void)signal;
    return -1;
}

int _getpid(void) { return 1; }
