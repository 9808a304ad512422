/* Plays the timer periods of reloads.h on one step pin.
 *
 *   P1.0   step
 *   P0.0   high while the axis turns
 *   P3     written once, at the end
 */
#include <8052.h>

#include "reloads.h"
#include "timer.h"

#if RELOADS_COUNT > 65535
#error "periods are counted in 16 bits"
#endif

/* `reload` is of the period that comes after the next overflow, and `edge_after` says whether an
   edge ends it; `edge` says so of the period that runs. */
static __data unsigned int reload;
static __bit edge, edge_after;

static __data unsigned int to_take = RELOADS_COUNT, to_end = RELOADS_COUNT;
static const __code unsigned int *__data next = reloads;
static const __code unsigned char *__data next_toggles = reloads_toggles;
static __data unsigned char toggles, bits;

#define TAKE() \
    do { \
        if (to_take != 0) { \
            to_take--; \
            reload = *next++ + TIMER_STOPPED; \
            if (bits == 0) { \
                toggles = *next_toggles++; \
                bits = 8; \
            } \
            edge_after = toggles & 1; \
            toggles >>= 1; \
            bits--; \
        } \
    } while (0)

void period(void) __interrupt(1) __using(1)
{
    TIMER_ADD(0, reload);
    if (edge)
        P1 ^= 1;
    edge = edge_after;
    if (--to_end == 0) {
        TR0 = 0;
        ET0 = 0;
    }
    TAKE();
}

void main(void)
{
    P0 = 0;
    P1 = 0;
    TMOD = 0x01;
    TAKE();
    /* The first period is loaded as it is: nothing has been counted. */
    TL0 = reload - TIMER_STOPPED;
    TH0 = (reload - TIMER_STOPPED) >> 8;
    edge = edge_after;
    TAKE();
    ET0 = 1;
    EA = 1;
    P0_0 = 1;
    TCON |= 0x10;
    while (ET0)
        ;
    P0_0 = 0;
    P3 = 0;
    for (;;)
        ;
}
