/* Reads segments from standard input, and writes the tick and the direction of each step. */
#include <inttypes.h>
#include <stdio.h>

#include "../src/segments.h"

static uint8_t bytes[1 << 24];

int main(void)
{
    const uint8_t *at = bytes, *end = bytes + fread(bytes, 1, sizeof bytes, stdin);
    struct segment segment;
    struct player player;
    uint64_t ticks = 0;
    uint32_t interval;

    while (at != end) {
        at = segment_decode(&segment, at, end);
        if (!at)
            return 1;
        ticks += player_load(&player, &segment);
        printf("%" PRIu64 " %c\n", ticks, segment.negative ? '-' : '+');
        while (player_next(&player, &interval)) {
            ticks += interval;
            printf("%" PRIu64 " %c\n", ticks, segment.negative ? '-' : '+');
        }
    }
    return 0;
}
