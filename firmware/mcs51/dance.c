/* Plays data.h on eight four-phase motors behind transparent latches on one bus.
 *
 *   P2.0..P2.3   data bus: the windings of one motor
 *   P1.0..P1.7   strobe of each latch; open while high
 *   P0.0         high while the tick's handler runs, for an oscilloscope
 *   P3           written once, at the end
 *
 * 12 MHz, a machine cycle of 1 us. Settings of the build, each with -D:
 *
 *   LAW          LAW_RESET, LAW_CARRY_MAGNITUDE, LAW_CARRY_SIGNED (LAW_CARRY_SIGNED)
 *   RESTART      RESTART_WRITE, RESTART_ADD (RESTART_ADD)
 *   RESTART_LAST the timer is restarted at the end of the handler, not at its start
 */
#include <8052.h>

#include "data.h"
#include "timer.h"

#define LAW_RESET 0
#define LAW_CARRY_MAGNITUDE 1
#define LAW_CARRY_SIGNED 2

#ifndef LAW
#define LAW LAW_CARRY_SIGNED
#endif
#ifndef RESTART
#define RESTART RESTART_ADD
#endif

#define MOTORS 8
#if DANCE_MOTORS != MOTORS
#error "the bus has eight latches"
#endif

/* At which a motor makes a half step. */
#define THRESHOLD DANCE_THRESHOLD
#if THRESHOLD < 128
#error "a speed of -128 would need more than one step per tick"
#endif
#if THRESHOLD > 32639
#error "a sum and a speed must fit 16 bits"
#endif

/* With its entry and exit the handler takes at most 890 cycles; `main` needs 700 of the others for
   the next frame. */
#if DANCE_TICK_US > 65535 || DANCE_FRAME_TICKS * (DANCE_TICK_US - 890) < 700
#error "the tick does not fit the timer, or a frame is too short to read the next one"
#endif

#if DANCE_FRAMES > 65535 || DANCE_FRAME_TICKS > 65535
#error "frames and their ticks are counted in 16 bits"
#endif

#define LOAD (65536 - DANCE_TICK_US)

static const __code unsigned char turn[8] = { 1, 3, 2, 6, 4, 12, 8, 9 };

static __idata int sums[MOTORS];
static __idata unsigned char phases[MOTORS];

/* The speeds in force, and those of the next frame, which `main` takes meanwhile: the handler only
   changes sides, so that no tick is much longer than another. */
static __idata signed char speeds[2 * MOTORS];
static __data unsigned char side;
static __bit wanted;

/* What the restart writes or adds. */
#if RESTART == RESTART_ADD
static __data unsigned int reload = LOAD + TIMER_STOPPED;
#define TIMER_RESTART() TIMER_ADD(0, reload)
#else
static __data unsigned int reload = LOAD;
#define TIMER_RESTART() TIMER_WRITE(0, reload)
#endif

static __data unsigned int frames_left = DANCE_FRAMES;
static __data unsigned int ticks_left = DANCE_FRAME_TICKS;

static const __code unsigned char *__data next = (const __code unsigned char *)dance;
static __idata signed char frame[MOTORS];
#if DANCE_PACKING != 0
static __data unsigned char run;
#endif

/* Reads the next frame and puts it where the handler will look from `to` on. */
static void take_frame(unsigned char to)
{
    unsigned char motor;
#if DANCE_PACKING == 2
    unsigned char mask;
#endif

#if DANCE_PACKING != 0
    if (run == 0) {
        run = *next++;
#endif
#if DANCE_PACKING == 2
        mask = *next++;
        for (motor = 0; motor < MOTORS; motor++) {
            if (mask & 1)
                frame[motor] = (signed char)*next++;
            mask >>= 1;
        }
#else
        for (motor = 0; motor < MOTORS; motor++)
            frame[motor] = (signed char)*next++;
#endif
#if DANCE_PACKING != 0
    }
    run--;
#endif
    for (motor = 0; motor < MOTORS; motor++)
        speeds[to + motor] = frame[motor];
}

/* Data, strobe up, strobe down: the data never changes under a high strobe. */
#define LATCH(strobe, windings) \
    do { \
        P2 = (windings); \
        P1 = (strobe); \
        P1 = 0; \
    } while (0)

void tick(void) __interrupt(1) __using(1)
{
    unsigned char motor;
    unsigned char strobe = 1;

    P0_0 = 1;
#ifndef RESTART_LAST
    TIMER_RESTART();
#endif
    for (motor = 0; motor < MOTORS; motor++) {
        signed char speed = speeds[side + motor];
        unsigned char phase;
        int sum = sums[motor];
#if LAW == LAW_CARRY_SIGNED
        signed char step = 0;

        sum += speed;
        if (sum >= THRESHOLD) {
            sum -= THRESHOLD;
            step = 1;
        } else if (sum <= -THRESHOLD) {
            sum += THRESHOLD;
            step = -1;
        }
        if (step != 0) {
            phase = (phases[motor] + step) & 7;
#else
        sum += speed < 0 ? -speed : speed;
        if (sum >= THRESHOLD) {
#if LAW == LAW_RESET
            sum = 0;
#else
            sum -= THRESHOLD;
#endif
            phase = (phases[motor] + (speed < 0 ? -1 : 1)) & 7;
#endif
            phases[motor] = phase;
            LATCH(strobe, turn[phase]);
        }
        sums[motor] = sum;
        strobe <<= 1;
    }
    if (--ticks_left == 0) {
        ticks_left = DANCE_FRAME_TICKS;
        if (--frames_left == 0)
            ET0 = 0;
        side ^= MOTORS;
        wanted = 1;
    }
#ifdef RESTART_LAST
    TIMER_RESTART();
#endif
    P0_0 = 0;
}

void main(void)
{
    unsigned char motor;
    unsigned int to_take = DANCE_FRAMES;

    P0 = 0;
    P1 = 0;
    for (motor = 0; motor < MOTORS; motor++)
        LATCH(1 << motor, turn[0]);
    take_frame(0);
    wanted = 1;
    TMOD = 0x01;
    TL0 = LOAD & 0xFF;
    TH0 = LOAD >> 8;
    ET0 = 1;
    EA = 1;
    TCON |= 0x10;
    while (ET0) {
        if (wanted) {
            wanted = 0;
            if (--to_take != 0)
                take_frame(side ^ MOTORS);
        }
    }
    P3 = 0;
    for (;;)
        ;
}
