/* Steps of Klipper's chelper along the lines of the bench `pipeline`: trapezoids of speed, a root of
 * the inverse kinematics for each step, compression for the wire within 25 us, at 72 MHz.
 *
 * Klipper has no SCARA: its solver gets one here. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "compiler.h"
#include "itersolve.h"
#include "stepcompress.h"
#include "trapq.h"

#define LINES 12
#define ROUNDS 30
#define MAX_PIECES 200000
static const double FEED = 300.0, ACCELERATION = 5000.0, TICK_HZ = 72e6, MAX_ERROR_S = 25e-6;

struct stepper_kinematics *rotary_delta_stepper_alloc(double radius, double height, double angle,
                                                      double upper, double lower);

static const double LINK = 132.0;

static double elbow(double x, double y)
{
    return acos((x * x + y * y - 2.0 * LINK * LINK) / (2.0 * LINK * LINK));
}

static double elbow_position(struct stepper_kinematics *sk, struct move *m, double time)
{
    struct coord at = move_get_coord(m, time);
    return elbow(at.x, at.y);
}

static double shoulder_position(struct stepper_kinematics *sk, struct move *m, double time)
{
    struct coord at = move_get_coord(m, time);
    /* Links of the same length. */
    return atan2(at.y, at.x) - 0.5 * elbow(at.x, at.y);
}

static struct stepper_kinematics *joint(sk_calc_callback position)
{
    struct stepper_kinematics *sk = calloc(1, sizeof(*sk));
    sk->calc_position_cb = position;
    sk->active_flags = AF_X | AF_Y | AF_Z;
    return sk;
}

struct line {
    double from[3], to[3];
};

static struct line arm_line(int k)
{
    return (struct line){{-90.0 + 4.0 * k, 90.0 + 9.0 * k, 0.0}, {95.0, 190.0 - 9.0 * k, 0.0}};
}

static struct line delta_line(int k)
{
    return (struct line){{-80.0 + 3.0 * k, -40.0 + 5.0 * k, -260.0},
                         {80.0, 40.0 - 5.0 * k, -285.0 + 2.0 * k}};
}

/* One line of a machine; adds its steps and seconds. */
static void run(struct line line, int is_arm, double steps_per_turn, double *steps, double *seconds)
{
    int axes = is_arm ? 2 : 3;
    struct stepper_kinematics *sk[3];
    struct stepcompress *sc[3];
    struct trapq *tq = trapq_alloc();
    for (int axis = 0; axis < axes; axis++) {
        sk[axis] = is_arm ? joint(axis ? elbow_position : shoulder_position)
                          : rotary_delta_stepper_alloc(24.0, 0.0, 2.0 * M_PI / 3.0 * axis, 120.0, 243.0);
        sc[axis] = stepcompress_alloc(axis);
        stepcompress_fill(sc[axis], (uint32_t)(MAX_ERROR_S * TICK_HZ), 1, 2);
        itersolve_set_stepcompress(sk[axis], sc[axis], 2.0 * M_PI / steps_per_turn);
        itersolve_set_trapq(sk[axis], tq);
        itersolve_set_position(sk[axis], line.from[0], line.from[1], line.from[2]);
    }
    struct steppersync *ss = steppersync_alloc(NULL, sc, axes, 16);
    steppersync_set_time(ss, 0.0, TICK_HZ);

    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    double change[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        change[i] = line.to[i] - line.from[i];
        length += change[i] * change[i];
    }
    length = sqrt(length);
    double ramp = FEED / ACCELERATION, cruise = length / FEED - ramp, start = 0.001;
    trapq_append(tq, start, ramp, cruise, ramp, line.from[0], line.from[1], line.from[2],
                 change[0] / length, change[1] / length, change[2] / length, 0.0, FEED, ACCELERATION);
    double over = start + 2.0 * ramp + cruise + 0.001;
    for (int axis = 0; axis < axes; axis++) {
        if (itersolve_generate_steps(sk[axis], over) || stepcompress_reset(sc[axis], 0))
            exit(1);
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    *seconds += (end.tv_sec - begin.tv_sec) + 1e-9 * (end.tv_nsec - begin.tv_nsec);

    static struct pull_history_steps pieces[MAX_PIECES];
    for (int axis = 0; axis < axes; axis++) {
        int count = stepcompress_extract_old(sc[axis], pieces, MAX_PIECES, 0, UINT64_MAX);
        for (int i = 0; i < count; i++)
            *steps += abs(pieces[i].step_count);
        stepcompress_free(sc[axis]);
        free(sk[axis]);
    }
    trapq_free(tq);
}

int main(void)
{
    static const struct {
        const char *name;
        int is_arm;
        double steps_per_turn;
    } cases[] = {
        {"arm, 32000 steps a turn", 1, 32000.0},
        {"arm, 3200 steps a turn", 1, 3200.0},
        {"delta, 86400 steps a turn", 0, 86400.0},
        {"delta, 5400 steps a turn", 0, 5400.0},
    };
    for (int i = 0; i < 4; i++) {
        double best = 0.0;
        for (int round = 0; round < ROUNDS; round++) {
            double steps = 0.0, seconds = 0.0;
            for (int k = 0; k < LINES; k++) {
                struct line line = cases[i].is_arm ? arm_line(k) : delta_line(k);
                run(line, cases[i].is_arm, cases[i].steps_per_turn, &steps, &seconds);
            }
            double millions = steps / seconds / 1e6;
            best = millions > best ? millions : best;
        }
        printf("%s;%f\n", cases[i].name, best);
    }
    return 0;
}
