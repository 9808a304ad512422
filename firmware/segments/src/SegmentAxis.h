/*
 * One axis of an ATmega (Uno, Nano, Mega) that plays segments of pvt-steps.
 *
 * Timer 1 counts ticks of 8 cycles, 0.5 us at 16 MHz, and its compare unit itself raises the step pin
 * OC1A (Uno and Nano: 9, Mega: 11) at the tick of a step: no other interrupt moves it. A step has two
 * interrupts. That of its rising edge sets the falling one and computes the next interval; that of its
 * falling edge sets the next rising one.
 *
 *     SegmentAxis axis;
 *     ISR(TIMER1_COMPA_vect) { axis.on_compare(); }
 */
#ifndef SEGMENT_AXIS_H
#define SEGMENT_AXIS_H

#include <Arduino.h>

#include "segments.h"

class SegmentAxis {
public:
    /* Takes timer 1 and its pin. The direction pin is low for positive steps. */
    void begin(uint8_t direction_pin)
    {
        direction_port_ = portOutputRegister(digitalPinToPort(direction_pin));
        direction_mask_ = digitalPinToBitMask(direction_pin);
        pinMode(direction_pin, OUTPUT);
        digitalWrite(STEP_PIN, LOW);
        pinMode(STEP_PIN, OUTPUT);
        TIMSK1 = 0;
        TCCR1A = 0;
        TCCR1B = _BV(CS11);
    }

    /* Whether there is room for a segment: ask before each `write`. */
    bool is_ready() const { return !has_failed_ && static_cast<uint8_t>(put_ - taken_) < SEGMENTS; }

    /* Takes a byte of the wire; true where it ends a segment. */
    bool write(uint8_t byte)
    {
        bytes_[length_++] = byte;
        segment decoded;
        if (!segment_decode(&decoded, bytes_, bytes_ + length_)) {
            has_failed_ = length_ == sizeof bytes_;
            return false;
        }
        length_ = 0;
        queued *next = &segments_[put_ % SEGMENTS];
        next->delay_ticks = player_load(&next->player, &decoded);
        next->negative = decoded.negative;
        put_++;
        if (!is_ready())
            start();
        return true;
    }

    /* At rest, plays what was put: by itself once there is no room for more, so that the next segment
       is there when it is due. Call it where nothing came for a while: it may be the end. */
    void start()
    {
        noInterrupts();
        if (phase_ == AT_REST && taken_ != put_)
            leave_rest();
        interrupts();
    }

    /* Whether bytes came that are no segment: nothing is taken any more. */
    bool has_failed() const { return has_failed_; }

    /* Whether every segment was played. */
    bool is_idle() const { return phase_ == AT_REST; }

    /* Steps that could not come at their tick, because their segment or the processor was late. What
       follows such a step keeps its distance from it. */
    uint16_t late_steps() const { return copy(late_steps_); }

    /* Positive steps less negative ones. */
    int32_t position() const { return copy(position_); }

    /* The handler of TIMER1_COMPA_vect. */
    void on_compare()
    {
        switch (phase_) {
        case AT_REST:
            last_ += CHUNK_TICKS;
            idle_ticks_ += CHUNK_TICKS;
            rest();
            break;
        case WAIT:
            last_ += CHUNK_TICKS;
            arm();
            break;
        case STEP_AHEAD:
            OCR1A = TCNT1 + PULSE_TICKS;
            phase_ = PULSE;
            last_ = step_;
            position_ += negative_ ? -1 : 1;
            has_interval_ = player_next(player_, &interval_);
            break;
        case PULSE:
            if (has_interval_ && interval_ <= LONGEST_WAIT_TICKS) {
                arm_step(static_cast<uint16_t>(interval_));
            } else if (has_interval_) {
                wait_ticks_ = interval_;
                arm();
            } else if (++taken_ != put_) {
                take();
                arm();
            } else {
                idle_ticks_ = 0;
                rest();
            }
            break;
        }
    }

private:
#if defined(__AVR_ATmega1280__) || defined(__AVR_ATmega2560__)
    static const uint8_t STEP_PIN = 11;
#else
    static const uint8_t STEP_PIN = 9;
#endif
    static const uint8_t SEGMENTS = 8;
    static const uint16_t PULSE_TICKS = 4;
    /* So much before a tick the compare unit is sure to be set to it. */
    static const uint16_t AHEAD_TICKS = 10;
    /* The unit counts 16 bits: longer waits are cut up. */
    static const uint16_t CHUNK_TICKS = 0x8000;
    static const uint16_t LONGEST_WAIT_TICKS = 0xF000;

    enum { AT_REST, WAIT, STEP_AHEAD, PULSE };

    struct queued {
        struct player player;
        uint64_t delay_ticks;
        bool negative;
    };

    template <typename T> static T copy(const T &value)
    {
        uint8_t sreg = SREG;
        noInterrupts();
        T copied = *const_cast<const volatile T *>(&value);
        SREG = sreg;
        return copied;
    }

    /* Plays the first segment after a rest: its delay counts from the last step, or from now where
       there was none. */
    void leave_rest()
    {
        uint16_t now = TCNT1;
        OCR1A = now - 1; /* far */
        TIFR1 = _BV(OCF1A);
        take();
        if (!has_run_) {
            has_run_ = true;
            last_ = now;
        } else if (wait_ticks_ > idle_ticks_ + static_cast<uint16_t>(now - last_)) {
            wait_ticks_ -= idle_ticks_;
        } else {
            late_steps_++;
            last_ = now;
            wait_ticks_ = 2 * AHEAD_TICKS;
        }
        arm();
        TIMSK1 = _BV(OCIE1A);
    }

    void take()
    {
        queued *next = &segments_[taken_ % SEGMENTS];
        player_ = &next->player;
        wait_ticks_ = next->delay_ticks;
        negative_ = next->negative;
        if (negative_)
            *direction_port_ |= direction_mask_;
        else
            *direction_port_ &= ~direction_mask_;
    }

    /* Nothing to play: the time since the last step is counted on. */
    void rest()
    {
        phase_ = AT_REST;
        TCCR1A = 0;
        OCR1A = last_ + CHUNK_TICKS;
    }

    /* The next compare: a step `wait_ticks_` after `last_`, or a piece of the way there. */
    void arm()
    {
        if (wait_ticks_ > LONGEST_WAIT_TICKS) {
            phase_ = WAIT;
            TCCR1A = 0;
            wait_ticks_ -= CHUNK_TICKS;
            OCR1A = last_ + CHUNK_TICKS;
            return;
        }
        arm_step(static_cast<uint16_t>(wait_ticks_));
    }

    void arm_step(uint16_t wait)
    {
        uint16_t passed = TCNT1 - last_;
        step_ = last_ + wait;
        if (wait < passed + AHEAD_TICKS) {
            late_steps_++;
            step_ = last_ + passed + AHEAD_TICKS;
        }
        phase_ = STEP_AHEAD;
        OCR1A = step_;
        TCCR1A = _BV(COM1A0); /* toggles the pin at the compare */
    }

    queued segments_[SEGMENTS];
    player *player_;
    uint64_t wait_ticks_, idle_ticks_;
    uint32_t interval_;
    int32_t position_;
    uint16_t last_, step_, late_steps_;
    volatile uint8_t put_, taken_, phase_;
    volatile uint8_t *direction_port_;
    uint8_t direction_mask_;
    /* As many as the longest segment has. */
    uint8_t bytes_[43];
    uint8_t length_;
    bool negative_, has_interval_, has_run_, has_failed_;
};

#endif
