//! Motors on four winding pins.

use crate::{Phase, Phases};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{OutputPin, PinState};

/// The four windings of a motor on four pins: bits 0 to 3 of [`Phases::nibble`].
///
/// At a step, pins are cleared first, then the dead time passes, then pins are set: both switches
/// of one half of a bridge are never on.
///
/// # Examples
/// ```
/// use motor_phases::WindingPins;
/// use motor_phases::{Phases, Stepping, Wiring};
/// # fn demo<P, D>(pins: [P; 4], mut delay: D) -> Result<(), Box<dyn core::error::Error>>
/// # where P: embedded_hal::digital::OutputPin, P::Error: core::error::Error + 'static, D: embedded_hal::delay::DelayNs {
/// let phases = Phases::new(Stepping::Full, Wiring::BIPOLAR)?;
/// let mut motor = WindingPins::new(pins, phases, 1000);
/// motor.hold(&mut delay)?;
/// for step in [1, 1, -1] {
///     motor.step(step, &mut delay)?;
/// }
/// motor.release()?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct WindingPins<P> {
    pins: [P; 4],
    phases: Phases,
    phase: Phase,
    // Windings that may be on. All, until the pins have been set.
    on: u8,
    // Windings went off, and no dead time has been waited since.
    released: bool,
    dead_time_ns: u32,
}

impl<P: OutputPin> WindingPins<P> {
    /// A motor in its first phase, with a dead time between off and on in nanoseconds: 0 for a
    /// unipolar motor. The pins are not touched yet.
    pub const fn new(pins: [P; 4], phases: Phases, dead_time_ns: u32) -> Self {
        Self {
            pins,
            phases,
            phase: phases.start(),
            on: 0xF,
            released: false,
            dead_time_ns,
        }
    }

    /// The phase in which the motor stands, or stood when it was released.
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// Puts current into the windings of the phase.
    ///
    /// # Errors
    /// That of a pin; a later call sets all of them.
    pub fn hold(&mut self, delay: &mut impl DelayNs) -> Result<(), P::Error> {
        let wanted = self.phases.nibble(self.phase) ^ self.phases.off_nibble();
        let off = self.on & !wanted;
        if off != 0 {
            self.switch(off, false)?;
            self.on &= wanted;
            self.released = true;
        }
        if self.released {
            delay.delay_ns(self.dead_time_ns);
            self.released = false;
        }
        // Also those that are on: an error may have left them off.
        self.on |= wanted;
        self.switch(wanted, true)
    }

    /// Moves by `steps`, in practice -1, 0 or 1: a rotor does not follow a jump. Holds at 0.
    ///
    /// # Errors
    /// As [`hold`](Self::hold); the phase has moved.
    pub fn step(
        &mut self,
        steps: impl Into<i32>,
        delay: &mut impl DelayNs,
    ) -> Result<(), P::Error> {
        self.phase = self.phases.advance(self.phase, steps);
        self.hold(delay)
    }

    /// Takes the current off all windings; the phase is kept for the next step.
    ///
    /// # Errors
    /// That of a pin.
    pub fn release(&mut self) -> Result<(), P::Error> {
        self.switch(0xF, false)?;
        self.released |= self.on != 0;
        self.on = 0;
        Ok(())
    }

    /// Gives the pins back.
    pub fn into_pins(self) -> [P; 4] {
        self.pins
    }

    /// Sets the pins of a mask.
    fn switch(&mut self, mask: u8, on: bool) -> Result<(), P::Error> {
        let nibble = if on { mask } else { 0 } ^ self.phases.off_nibble();
        for (bit, pin) in (0..).zip(&mut self.pins) {
            if mask.wrapping_shr(bit) & 1 == 1 {
                pin.set_state(PinState::from(nibble.wrapping_shr(bit) & 1 == 1))?;
            }
        }
        Ok(())
    }
}
