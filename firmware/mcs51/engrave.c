/* Plays the records of pattern.h on step and direction pins, two axes at once on timers 0 and 1.
 *
 *   P1.0..P1.3   step: elbow, shoulder, disc, vertical; a pulse is high, then low
 *   P1.4..P1.7   direction of the same, high for negative
 *   P0.0         high while axes turn
 *   P3           written once, at the end
 *
 * The axis with more pulses runs at HALF_PERIOD machine cycles an edge, the other so that both end
 * together. Settings of the build, each with -D:
 *
 *   HALF_PERIOD    cycles between edges (4096)
 *   RESTART        RESTART_WRITE, RESTART_ADD (RESTART_ADD)
 *   SINGLE_RELOAD  one reload of 16 bits for all edges of an axis, as in the paper; without it the
 *                  remainder is distributed and a long interval is made of two timer periods
 */
#include <8052.h>

#include "pattern.h"
#include "timer.h"

#ifndef HALF_PERIOD
#define HALF_PERIOD 4096
#endif
#ifndef RESTART
#define RESTART RESTART_ADD
#endif

#if HALF_PERIOD < 250
#error "the handlers of both timers must fit a period"
#endif
/* The most pulses in a slow record are 30: 30 to 1 must fit two periods. */
#if HALF_PERIOD * 30 > 131071
#error "an interval would need more than two timer periods"
#endif

#define FAST_MARK 0x1F
#define COUNT_BITS 0x1F
#define NEGATIVE 0x80

#define ELBOW 0x01
#define SHOULDER 0x02
#define DISC 0x04
#define VERTICAL 0x08

#if RESTART == RESTART_ADD
#define STOPPED TIMER_STOPPED
#define TIMER_RESTART(n, reload) TIMER_ADD(n, reload)
#else
#define STOPPED 0
#define TIMER_RESTART(n, reload) TIMER_WRITE(n, reload)
#endif

/* One timer and the axis on it. `reload` is of the period that comes after the next overflow, and
   `edge_after` says whether an edge ends it; `edge` says so of the period that runs. */
#define TIMER_STATE(n) \
    static __data unsigned int reload##n; \
    static __bit edge##n, edge_after##n; \
    static __bit high##n; \
    static __data unsigned char pin##n; \
    static __data unsigned int pulses##n; \
    static __data unsigned int first_reload##n, last_reload##n; \
    static __bit split##n, split_pending##n; \
    static __data unsigned char share##n, remainder##n, to_next_long##n

TIMER_STATE(0);
TIMER_STATE(1);

/* Plans one more period: the first of a long interval, or the last one, which carries the
   remainder: it is a cycle longer where `to_next_long` passes zero. */
#define PLAN(n) \
    do { \
        if (split_pending##n) { \
            split_pending##n = 0; \
            reload##n = first_reload##n; \
            edge_after##n = 0; \
        } else { \
            split_pending##n = split##n; \
            reload##n = last_reload##n; \
            if (to_next_long##n < remainder##n) { \
                reload##n--; \
                to_next_long##n += share##n; \
            } \
            to_next_long##n -= remainder##n; \
            edge_after##n = 1; \
        } \
    } while (0)

#define HANDLER(n) \
    do { \
        TIMER_RESTART(n, reload##n); \
        if (edge##n) { \
            P1 ^= pin##n; \
            high##n = !high##n; \
            if (!high##n && --pulses##n == 0) { \
                TR##n = 0; \
                ET##n = 0; \
            } \
        } \
        edge##n = edge_after##n; \
        PLAN(n); \
    } while (0)

void timer0(void) __interrupt(1) __using(1)
{
    HANDLER(0);
}

void timer1(void) __interrupt(3) __using(1)
{
    HANDLER(1);
}

/* What both timers need of an axis with `count` pulses when the faster one has `most`. */
static __data unsigned int plan_first, plan_last;
static __bit plan_split;
static __data unsigned char plan_remainder;

static void plan(unsigned int count, unsigned int most)
{
    unsigned long whole = HALF_PERIOD;

    plan_remainder = 0;
    plan_split = 0;
    if (count != most) {
        unsigned long half_time = (unsigned long)HALF_PERIOD * most;

        whole = half_time / count;
#ifndef SINGLE_RELOAD
        plan_remainder = half_time % count;
        if (whole >= 65536) {
            plan_split = 1;
            plan_first = STOPPED - (unsigned int)(whole >> 1);
            whole -= whole >> 1;
        }
#endif
    }
    plan_last = STOPPED - (unsigned int)whole;
}

/* Makes an axis ready on its timer; the first period is loaded as it is, nothing has been counted. */
#define PREPARE(n, axis, count, most) \
    do { \
        plan(count, most); \
        pin##n = axis; \
        pulses##n = count; \
        high##n = 0; \
        first_reload##n = plan_first; \
        last_reload##n = plan_last; \
        split##n = plan_split; \
        split_pending##n = plan_split; \
        remainder##n = plan_remainder; \
        share##n = count; \
        to_next_long##n = count - 1; \
        PLAN(n); \
        TL##n = reload##n - STOPPED; \
        TH##n = (reload##n - STOPPED) >> 8; \
        edge##n = edge_after##n; \
        PLAN(n); \
    } while (0)

static void set_direction(unsigned char axis, unsigned char byte)
{
    axis <<= 4;
    if (byte & NEGATIVE)
        P1 |= axis;
    else
        P1 &= ~axis;
}

/* Turns `axis0` and `axis1` at once, and waits until both have ended. */
static void turn(unsigned char axis0, unsigned int count0, unsigned char axis1, unsigned char count1)
{
    unsigned int most = count0 > count1 ? count0 : count1;
    unsigned char run = 0;

    if (count0 != 0) {
        PREPARE(0, axis0, count0, most);
        ET0 = 1;
        run = 0x10;
    }
    if (count1 != 0) {
        PREPARE(1, axis1, count1, most);
        ET1 = 1;
        run |= 0x40;
    }
    if (run == 0)
        return;
    P0_0 = 1;
    /* Both start in the same cycle. */
    TCON |= run;
    while (ET0 || ET1)
        ;
    P0_0 = 0;
}

static unsigned char axis_of(unsigned char byte)
{
    switch ((byte >> 5) & 3) {
    case PATTERN_ELBOW_CODE:
        return ELBOW;
    case PATTERN_SHOULDER_CODE:
        return SHOULDER;
    case PATTERN_DISC_CODE:
        return DISC;
    default:
        return VERTICAL;
    }
}

void main(void)
{
    const __code unsigned char *byte = pattern;
    unsigned int left;

    P0 = 0;
    P1 = 0;
    TMOD = 0x11;
    EA = 1;
    for (left = PATTERN_RECORDS; left != 0; left--) {
        if ((byte[0] & COUNT_BITS) == FAST_MARK) {
            unsigned char axis = axis_of(byte[0]);

            set_direction(axis, byte[0]);
#if PATTERN_HIGH_BYTE_FIRST
            turn(axis, (unsigned int)byte[1] << 8 | byte[2], 0, 0);
#else
            turn(axis, (unsigned int)byte[2] << 8 | byte[1], 0, 0);
#endif
        } else {
            set_direction(DISC, byte[0]);
            turn(DISC, byte[0] & COUNT_BITS, 0, 0);
            set_direction(ELBOW, byte[1]);
            set_direction(SHOULDER, byte[2]);
            turn(ELBOW, byte[1] & COUNT_BITS, SHOULDER, byte[2] & COUNT_BITS);
        }
        byte += 3;
    }
    P3 = 0;
    for (;;)
        ;
}
