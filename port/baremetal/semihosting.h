/* What a bare-metal image of the tests can ask of the machine it runs under. SPDX-License-Identifier: MIT */
#ifndef GOE_PORT_SEMIHOSTING_H
#define GOE_PORT_SEMIHOSTING_H

/* Writes a text to the debugger's or emulator's console. */
void port_write_text(const char *text);

void port_write_char(char character);

/* Ends the run; status is what the emulator returns, 0 to 255. */
__attribute__((noreturn)) void port_exit(int status);

#endif
