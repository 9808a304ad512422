/*
 * Segments of pvt-steps on a microcontroller: a decoder and a player, C99, no library.
 *
 * The interrupt handler of an axis:
 *
 *     uint32_t interval;
 *     if (player_next(&player, &interval))
 *         compare += interval;               // the next step of this segment
 *     else
 *         load the next segment, set the direction pin, compare += player_load(...);
 *
 * Bytes and differences are described at `Segment` of pvt-steps. Segments that its `decode`
 * accepts are played forwards in time; here only what is needed to stay within the bytes is checked.
 */
#ifndef SEGMENTS_H
#define SEGMENTS_H

#include <stdbool.h>
#include <stdint.h>

struct segment {
    uint64_t delay_ticks; /* from the last step before it to its first */
    uint64_t differences[3];
    uint16_t count;
    uint8_t phase;
    bool negative;
};

/* Times in 2^-32 ticks; unsigned, so that what is below zero wraps. */
struct player {
    uint64_t time, interval, second, third;
    uint16_t left;
};

/* Takes a segment, and returns the ticks from the last step to its first. */
static inline uint64_t player_load(struct player *player, const struct segment *segment)
{
    unsigned coarser = 0;

    while (coarser < 9 && segment->count <= 512u >> coarser)
        coarser++;
    player->time = (uint64_t)segment->phase << 24;
    player->interval = segment->differences[0] << (16 + coarser);
    player->second = segment->differences[1] << (8 + 2 * coarser);
    player->third = segment->differences[2] << (3 * coarser);
    player->left = segment->count - 1;
    return segment->delay_ticks;
}

/* What gcc makes of 64 bits on an AVR takes five times the cycles. */
static inline uint32_t player_ticks(const uint64_t *time)
{
#ifdef __AVR__
    uint32_t ticks;

    __builtin_memcpy(&ticks, (const uint8_t *)time + 4, sizeof ticks);
    return ticks;
#else
    return (uint32_t)(*time >> 32);
#endif
}

static inline void player_add(uint64_t *sum, const uint64_t *addend)
{
#ifdef __AVR__
    uint8_t byte;

    __asm__ volatile("ld __tmp_reg__, X+\n\tld %0, Z\n\tadd %0, __tmp_reg__\n\tst Z+, %0\n\t"
                     ".rept 7\n\t"
                     "ld __tmp_reg__, X+\n\tld %0, Z\n\tadc %0, __tmp_reg__\n\tst Z+, %0\n\t"
                     ".endr"
                     : "=&r"(byte), "+z"(sum), "+x"(addend)
                     :
                     : "memory");
#else
    *sum += *addend;
#endif
}

/* Ticks from the last step to the next of the segment; false after the last. */
static inline bool player_next(struct player *player, uint32_t *ticks)
{
    uint32_t last = player_ticks(&player->time);

    if (player->left == 0)
        return false;
    player->left--;
    player_add(&player->time, &player->interval);
    player_add(&player->interval, &player->second);
    player_add(&player->second, &player->third);
    *ticks = player_ticks(&player->time) - last;
    return true;
}

/* A number of up to 64 bits, seven in a byte; false when the bytes end before. */
static inline bool segment_number(uint64_t *number, const uint8_t **bytes, const uint8_t *end)
{
    unsigned shift;

    *number = 0;
    for (shift = 0; shift < 64 && *bytes < end; shift += 7) {
        uint8_t byte = *(*bytes)++;

        *number |= (uint64_t)(byte & 0x7F) << shift;
        if (byte < 0x80)
            return true;
    }
    return false;
}

/* The segment at `bytes`; returns the byte after it, or 0 when it is none. */
static inline const uint8_t *segment_decode(struct segment *segment, const uint8_t *bytes,
                                            const uint8_t *end)
{
    unsigned differences, i;

    if (bytes >= end)
        return 0;
    segment->negative = *bytes >> 7;
    differences = *bytes >> 5 & 3;
    segment->count = (*bytes++ & 0x1F) + 1;
    segment->phase = 0;
    if (differences > 0) {
        if (end - bytes < 2 || *bytes > 31)
            return 0;
        segment->count = (uint16_t)(segment->count + *bytes++ * 32);
        segment->phase = *bytes++;
    }
    if (!segment_number(&segment->delay_ticks, &bytes, end))
        return 0;
    for (i = 0; i < 3; i++) {
        uint64_t number = 0;

        if (i < differences && !segment_number(&number, &bytes, end))
            return 0;
        /* The interval has no sign; the others have it in the lowest bit. */
        segment->differences[i] = i == 0 ? number : number >> 1 ^ (0 - (number & 1));
    }
    return bytes;
}

#endif
