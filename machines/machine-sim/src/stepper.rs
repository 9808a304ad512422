//! Steppers that count their pulses, and may lose some.

use crate::random::Random;

/// A stepper that follows each pulse by one step, or loses it at random.
///
/// Losses at random are what a loop closed over a scale is tested with; what a motor loses because
/// it is driven too fast is not at random.
///
/// # Examples
/// ```
/// use machine_sim::Stepper;
/// let mut x = Stepper::at(100).losing(0.01, 7);
/// for _ in 0..1000 {
///     x.step(1);
/// }
/// assert_eq!(x.position(), 1100 - i32::try_from(x.lost()).unwrap());
/// assert!((1..30).contains(&x.lost()));
/// ```
#[derive(Debug, Clone)]
pub struct Stepper {
    position: i32,
    loss: Option<(f64, Random)>,
    lost: u64,
}

impl Stepper {
    /// A stepper that stands at a position, in steps, and loses nothing.
    #[must_use]
    pub const fn at(position: i32) -> Self {
        Self {
            position,
            loss: None,
            lost: 0,
        }
    }

    /// The same, but each pulse is lost with a probability; which ones, the seed says.
    #[must_use]
    pub const fn losing(mut self, probability: f64, seed: u64) -> Self {
        self.loss = Some((probability, Random::new(seed)));
        self
    }

    /// One pulse: up for a number above 0, down for one below, none for 0.
    pub fn step(&mut self, direction: i32) {
        if direction == 0 {
            return;
        }
        if let Some((probability, random)) = &mut self.loss
            && random.happens(*probability)
        {
            self.lost += 1;
            return;
        }
        self.position = self.position.saturating_add(direction.signum());
    }

    /// Where it stands, in steps.
    #[must_use]
    pub const fn position(&self) -> i32 {
        self.position
    }

    /// Pulses that were lost.
    #[must_use]
    pub const fn lost(&self) -> u64 {
        self.lost
    }

    /// Counts lost pulses from here on.
    pub const fn forget_lost(&mut self) {
        self.lost = 0;
    }
}
