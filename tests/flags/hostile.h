/* Names that the headers of firmwares, frameworks and C libraries define as macros. This header is forced into every file of lib/: code
 * that uses one of them as an identifier does not compile. SPDX-License-Identifier: MIT
 *
 * The definitions do not matter. Standard headers come first: in the field they are read before the macros, too. */
#ifndef HOSTILE_H
#define HOSTILE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* NuttX's compiler.h, which PX4 forces into every file */
#undef NEAR
#define NEAR (a macro of somebody else
#undef FAR
#define FAR (a macro of somebody else
#undef CODE
#define CODE (a macro of somebody else
#undef DSEG
#define DSEG (a macro of somebody else
#undef IOBJ
#define IOBJ (a macro of somebody else
#undef IPTR
#define IPTR (a macro of somebody else
#undef CONFIG_SMALL_MEMORY
#define CONFIG_SMALL_MEMORY (a macro of somebody else
#undef packed_struct
#define packed_struct (a macro of somebody else
#undef weak_data
#define weak_data (a macro of somebody else
#undef weak_function
#define weak_function (a macro of somebody else
#undef noreturn_function
#define noreturn_function (a macro of somebody else
#undef begin_packed_struct
#define begin_packed_struct (a macro of somebody else
#undef end_packed_struct
#define end_packed_struct (a macro of somebody else
#undef locate_data
#define locate_data (a macro of somebody else
#undef inline_function
#define inline_function (a macro of somebody else
#undef noinline_function
#define noinline_function (a macro of somebody else
#undef predict_true
#define predict_true (a macro of somebody else
#undef predict_false
#define predict_false (a macro of somebody else
#undef UNUSED
#define UNUSED (a macro of somebody else
#undef OK
#define OK (a macro of somebody else
#undef ERROR
#define ERROR (a macro of somebody else
#undef TRUE
#define TRUE (a macro of somebody else
#undef FALSE
#define FALSE (a macro of somebody else

/* NuttX's limits.h, which its stdint.h reads */
#undef SIZE_MIN
#define SIZE_MIN (a macro of somebody else
#undef SSIZE_MIN
#define SSIZE_MIN (a macro of somebody else
#undef SSIZE_MAX
#define SSIZE_MAX (a macro of somebody else
#undef PTR_MIN
#define PTR_MIN (a macro of somebody else
#undef PTR_MAX
#define PTR_MAX (a macro of somebody else
#undef RSIZE_MAX
#define RSIZE_MAX (a macro of somebody else

/* PX4 and its drivers */
#undef PX4_OK
#define PX4_OK (a macro of somebody else
#undef PX4_ERROR
#define PX4_ERROR (a macro of somebody else
#undef PX4_INFO
#define PX4_INFO (a macro of somebody else
#undef PX4_WARN
#define PX4_WARN (a macro of somebody else
#undef PX4_ERR
#define PX4_ERR (a macro of somebody else
#undef BIT
#define BIT (a macro of somebody else
#undef SEC_PER_MIN
#define SEC_PER_MIN (a macro of somebody else
#undef arraySize
#define arraySize (a macro of somebody else
#undef FLT_EPSILON
#define FLT_EPSILON (a macro of somebody else
#undef M_PI_F
#define M_PI_F (a macro of somebody else
#undef M_TWOPI_F
#define M_TWOPI_F (a macro of somebody else
#undef math
#define math (a macro of somebody else

/* Arduino */
#undef min
#define min (a macro of somebody else
#undef max
#define max (a macro of somebody else
#undef abs
#define abs (a macro of somebody else
#undef round
#define round (a macro of somebody else
#undef sq
#define sq (a macro of somebody else
#undef constrain
#define constrain (a macro of somebody else
#undef radians
#define radians (a macro of somebody else
#undef degrees
#define degrees (a macro of somebody else
#undef bit
#define bit (a macro of somebody else
#undef bitRead
#define bitRead (a macro of somebody else
#undef bitSet
#define bitSet (a macro of somebody else
#undef bitClear
#define bitClear (a macro of somebody else
#undef bitWrite
#define bitWrite (a macro of somebody else
#undef lowByte
#define lowByte (a macro of somebody else
#undef highByte
#define highByte (a macro of somebody else
#undef interrupts
#define interrupts (a macro of somebody else
#undef noInterrupts
#define noInterrupts (a macro of somebody else
#undef _BV
#define _BV (a macro of somebody else
#undef F
#define F (a macro of somebody else
#undef PI
#define PI (a macro of somebody else
#undef HALF_PI
#define HALF_PI (a macro of somebody else
#undef TWO_PI
#define TWO_PI (a macro of somebody else
#undef DEG_TO_RAD
#define DEG_TO_RAD (a macro of somebody else
#undef RAD_TO_DEG
#define RAD_TO_DEG (a macro of somebody else
#undef EULER
#define EULER (a macro of somebody else
#undef HIGH
#define HIGH (a macro of somebody else
#undef LOW
#define LOW (a macro of somebody else
#undef INPUT
#define INPUT (a macro of somebody else
#undef OUTPUT
#define OUTPUT (a macro of somebody else
#undef INPUT_PULLUP
#define INPUT_PULLUP (a macro of somebody else
#undef SERIAL
#define SERIAL (a macro of somebody else
#undef DISPLAY
#define DISPLAY (a macro of somebody else
#undef DEFAULT
#define DEFAULT (a macro of somebody else
#undef EXTERNAL
#define EXTERNAL (a macro of somebody else
#undef INTERNAL
#define INTERNAL (a macro of somebody else
#undef CHANGE
#define CHANGE (a macro of somebody else
#undef FALLING
#define FALLING (a macro of somebody else
#undef RISING
#define RISING (a macro of somebody else
#undef B0
#define B0 (a macro of somebody else
#undef B1
#define B1 (a macro of somebody else
#undef B00
#define B00 (a macro of somebody else
#undef B01
#define B01 (a macro of somebody else
#undef B10
#define B10 (a macro of somebody else
#undef B11
#define B11 (a macro of somebody else
#undef B000
#define B000 (a macro of somebody else
#undef B111
#define B111 (a macro of somebody else
#undef B1000
#define B1000 (a macro of somebody else
#undef LSBFIRST
#define LSBFIRST (a macro of somebody else
#undef MSBFIRST
#define MSBFIRST (a macro of somebody else
#undef PROGMEM
#define PROGMEM (a macro of somebody else
#undef PSTR
#define PSTR (a macro of somebody else

/* Windows */
#undef near
#define near (a macro of somebody else
#undef far
#define far (a macro of somebody else
#undef small
#define small (a macro of somebody else
#undef hyper
#define hyper (a macro of somebody else
#undef interface
#define interface (a macro of somebody else
#undef IN
#define IN (a macro of somebody else
#undef OUT
#define OUT (a macro of somebody else
#undef OPTIONAL
#define OPTIONAL (a macro of somebody else
#undef CONST
#define CONST (a macro of somebody else
#undef VOID
#define VOID (a macro of somebody else
#undef BOOL
#define BOOL (a macro of somebody else
#undef CALLBACK
#define CALLBACK (a macro of somebody else
#undef WINAPI
#define WINAPI (a macro of somebody else
#undef STRICT
#define STRICT (a macro of somebody else
#undef RGB
#define RGB (a macro of somebody else
#undef DELETE
#define DELETE (a macro of somebody else
#undef NO_ERROR
#define NO_ERROR (a macro of somebody else
#undef IGNORE
#define IGNORE (a macro of somebody else
#undef DIFFERENCE
#define DIFFERENCE (a macro of somebody else
#undef ABSOLUTE
#define ABSOLUTE (a macro of somebody else
#undef RELATIVE
#define RELATIVE (a macro of somebody else
#undef TRANSPARENT
#define TRANSPARENT (a macro of somebody else
#undef OPAQUE
#define OPAQUE (a macro of somebody else

/* Zephyr, Linux and similar systems */
#undef MIN
#define MIN (a macro of somebody else
#undef MAX
#define MAX (a macro of somebody else
#undef ABS
#define ABS (a macro of somebody else
#undef CLAMP
#define CLAMP (a macro of somebody else
#undef SIGN
#define SIGN (a macro of somebody else
#undef ROUND_UP
#define ROUND_UP (a macro of somebody else
#undef ROUND_DOWN
#define ROUND_DOWN (a macro of somebody else
#undef ARRAY_SIZE
#define ARRAY_SIZE (a macro of somebody else
#undef CONTAINER_OF
#define CONTAINER_OF (a macro of somebody else
#undef IS_ENABLED
#define IS_ENABLED (a macro of somebody else
#undef KHZ
#define KHZ (a macro of somebody else
#undef MHZ
#define MHZ (a macro of somebody else
#undef BITS
#define BITS (a macro of somebody else
#undef WRITE_BIT
#define WRITE_BIT (a macro of somebody else
#undef GENMASK
#define GENMASK (a macro of somebody else
#undef SWAP
#define SWAP (a macro of somebody else
#undef DIV_ROUND_UP
#define DIV_ROUND_UP (a macro of somebody else
#undef linux
#define linux (a macro of somebody else
#undef unix
#define unix (a macro of somebody else
#undef i386
#define i386 (a macro of somebody else
#undef current
#define current (a macro of somebody else

/* STM32 and CMSIS */
#undef SET
#define SET (a macro of somebody else
#undef RESET
#define RESET (a macro of somebody else
#undef ENABLE
#define ENABLE (a macro of somebody else
#undef DISABLE
#define DISABLE (a macro of somebody else
#undef SUCCESS
#define SUCCESS (a macro of somebody else
#undef READ_BIT
#define READ_BIT (a macro of somebody else
#undef SET_BIT
#define SET_BIT (a macro of somebody else
#undef CLEAR_BIT
#define CLEAR_BIT (a macro of somebody else
#undef MODIFY_REG
#define MODIFY_REG (a macro of somebody else
#undef READ_REG
#define READ_REG (a macro of somebody else
#undef WRITE_REG
#define WRITE_REG (a macro of somebody else
#undef POSITION_VAL
#define POSITION_VAL (a macro of somebody else
#undef __IO
#define __IO (a macro of somebody else
#undef __I
#define __I (a macro of somebody else
#undef __O
#define __O (a macro of somebody else
#undef PACK
#define PACK (a macro of somebody else
#undef ASSERT
#define ASSERT (a macro of somebody else

/* C libraries: complex.h, ctype.h, old math.h, termios.h */
#undef I
#define I (a macro of somebody else
#undef complex
#define complex (a macro of somebody else
#undef imaginary
#define imaginary (a macro of somebody else
#undef DOMAIN
#define DOMAIN (a macro of somebody else
#undef SING
#define SING (a macro of somebody else
#undef OVERFLOW
#define OVERFLOW (a macro of somebody else
#undef UNDERFLOW
#define UNDERFLOW (a macro of somebody else
#undef PLOSS
#define PLOSS (a macro of somebody else
#undef TLOSS
#define TLOSS (a macro of somebody else
#undef HUGE
#define HUGE (a macro of somebody else
#undef _A
#define _A (a macro of somebody else
#undef _B
#define _B (a macro of somebody else
#undef _C
#define _C (a macro of somebody else
#undef _D
#define _D (a macro of somebody else
#undef _E
#define _E (a macro of somebody else
#undef _L
#define _L (a macro of somebody else
#undef _M
#define _M (a macro of somebody else
#undef _N
#define _N (a macro of somebody else
#undef _P
#define _P (a macro of somebody else
#undef _Q
#define _Q (a macro of somebody else
#undef _S
#define _S (a macro of somebody else
#undef _U
#define _U (a macro of somebody else
#undef _X
#define _X (a macro of somebody else
#undef PARENB
#define PARENB (a macro of somebody else
#undef ECHO
#define ECHO (a macro of somebody else
#undef NOFLSH
#define NOFLSH (a macro of somebody else
#undef EOF
#define EOF (a macro of somebody else

/* AVR and other registers */
#undef SP
#define SP (a macro of somebody else
#undef SREG
#define SREG (a macro of somebody else
#undef PORTA
#define PORTA (a macro of somebody else
#undef PORTB
#define PORTB (a macro of somebody else
#undef DDRA
#define DDRA (a macro of somebody else
#undef PINA
#define PINA (a macro of somebody else
#undef ADC
#define ADC (a macro of somebody else
#undef OCR1A
#define OCR1A (a macro of somebody else
#undef R0
#define R0 (a macro of somebody else
#undef R1
#define R1 (a macro of somebody else
#undef R2
#define R2 (a macro of somebody else
#undef X
#define X (a macro of somebody else
#undef Y
#define Y (a macro of somebody else
#undef Z
#define Z (a macro of somebody else
#undef A
#define A (a macro of somebody else
#undef Q
#define Q (a macro of somebody else
#undef D
#define D (a macro of somebody else
#undef E
#define E (a macro of somebody else
#undef H
#define H (a macro of somebody else
#undef W
#define W (a macro of somebody else
#undef S
#define S (a macro of somebody else

/* Betaflight, INAV, ArduPilot */
#undef power3
#define power3 (a macro of somebody else
#undef RAD
#define RAD (a macro of somebody else
#undef RADX
#define RADX (a macro of somebody else
#undef RADY
#define RADY (a macro of somebody else
#undef ARRAYLEN
#define ARRAYLEN (a macro of somebody else
#undef STATIC_ASSERT
#define STATIC_ASSERT (a macro of somebody else
#undef ToRad
#define ToRad (a macro of somebody else
#undef ToDeg
#define ToDeg (a macro of somebody else
#undef GRAVITY_MSS
#define GRAVITY_MSS (a macro of somebody else
#undef DISTANCE
#define DISTANCE (a macro of somebody else
#undef SCALE
#define SCALE (a macro of somebody else
#undef MODE_RATE
#define MODE_RATE (a macro of somebody else
#undef ROLL
#define ROLL (a macro of somebody else
#undef PITCH
#define PITCH (a macro of somebody else
#undef YAW
#define YAW (a macro of somebody else
#undef THROTTLE
#define THROTTLE (a macro of somebody else
#undef NORTH
#define NORTH (a macro of somebody else
#undef EAST
#define EAST (a macro of somebody else
#undef DOWN
#define DOWN (a macro of somebody else
#undef LEFT
#define LEFT (a macro of somebody else
#undef RIGHT
#define RIGHT (a macro of somebody else
#undef FRONT
#define FRONT (a macro of somebody else
#undef BACK
#define BACK (a macro of somebody else
#undef TOP
#define TOP (a macro of somebody else
#undef BOTTOM
#define BOTTOM (a macro of somebody else
#undef WIDTH
#define WIDTH (a macro of somebody else
#undef LENGTH
#define LENGTH (a macro of somebody else
#undef HEIGHT
#define HEIGHT (a macro of somebody else

#endif
