//! Speed and acceleration over time, from where something is at each step.

/// A window is not shorter: it would show single steps.
const MIN_WINDOW_S: f64 = 0.01;
const MAX_WINDOWS: usize = 2048;

/// Where a point of N coordinates is at the ends of at most 2048 windows of equal length, which
/// grow with the time.
///
/// # Examples
/// ```
/// // From rest 100 mm/s along x, in steps of 0.1 mm.
/// let mut sampler = machine_sim::MotionSampler::new([0.0, 0.0]);
/// for k in 1..=200_u32 {
///     sampler.add(f64::from(k) * 0.001, [f64::from(k) * 0.1, 0.0]);
/// }
/// let [_, speed] = sampler.speeds().last().unwrap();
/// let [_, change] = sampler.accelerations().next().unwrap();
/// assert!((speed - 100.0).abs() < 1e-6);
/// assert!((change - 100.0 / sampler.window_s()).abs() < 1e-6);
/// ```
#[derive(Debug, Clone)]
pub struct MotionSampler<const N: usize> {
    window_s: f64,
    /// The first at 0 s.
    points: Vec<[f64; N]>,
    last: (f64, [f64; N]),
}

impl<const N: usize> MotionSampler<N> {
    /// A sampler from a point on.
    #[must_use]
    pub fn new(start: [f64; N]) -> Self {
        Self {
            window_s: MIN_WINDOW_S,
            points: vec![start],
            last: (0.0, start),
        }
    }

    /// The length of a window, in s.
    #[must_use]
    pub const fn window_s(&self) -> f64 {
        self.window_s
    }

    /// Time in s and the point at the ends of the windows, the first at 0 s.
    pub fn points(&self) -> impl Iterator<Item = (f64, [f64; N])> {
        let ends = (0_u32..).map(|k| f64::from(k) * self.window_s);
        ends.zip(self.points.iter().copied())
    }

    /// It is at a point at a time; from the last one it has moved evenly.
    pub fn add(&mut self, t_s: f64, point: [f64; N]) {
        let (last_s, last) = self.last;
        loop {
            let end_s = as_f64(self.points.len()) * self.window_s;
            if end_s > t_s {
                break;
            }
            let fraction = (end_s - last_s) / (t_s - last_s);
            let mut at = last;
            for (at, to) in at.iter_mut().zip(point) {
                *at += (to - *at) * fraction;
            }
            self.points.push(at);
            if self.points.len() > MAX_WINDOWS {
                self.double();
            }
        }
        self.last = (t_s, point);
    }

    /// From a time on it stands where it is: one more window, at least.
    pub fn end(&mut self, t_s: f64) {
        let (_, last) = self.last;
        self.add(t_s, last);
        self.add(t_s + 2.0 * self.window_s, last);
    }

    /// Makes one window of two.
    fn double(&mut self) {
        self.points = self.points.iter().copied().step_by(2).collect();
        self.window_s *= 2.0;
    }

    /// Time in s and mean speed of each window.
    pub fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        self.over_time(0.5, self.velocities().map(length))
    }

    /// Time in s, and the change of the velocity from one window to the next over the time between
    /// them; it starts from rest.
    pub fn accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        self.over_time(0.0, self.velocity_changes().map(length))
    }

    /// The same of the axis that has the largest.
    pub fn axis_accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        let largest = |change: [f64; N]| change.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
        self.over_time(0.0, self.velocity_changes().map(largest))
    }

    fn velocity_changes(&self) -> impl Iterator<Item = [f64; N]> {
        let before = core::iter::once([0.0; N]).chain(self.velocities());
        let changes = before.zip(self.velocities());
        changes.map(|(from, to)| self.change(from, to))
    }

    fn velocities(&self) -> impl Iterator<Item = [f64; N]> {
        let ends = self.points.iter().zip(self.points.iter().skip(1));
        ends.map(|(a, b)| self.change(*a, *b))
    }

    /// From one value to the next, over a window.
    fn change(&self, from: [f64; N], mut to: [f64; N]) -> [f64; N] {
        for (to, from) in to.iter_mut().zip(from) {
            *to = (*to - from) / self.window_s;
        }
        to
    }

    /// Values of one window after the other, the first after a number of windows.
    fn over_time(
        &self,
        first: f64,
        values: impl Iterator<Item = f64>,
    ) -> impl Iterator<Item = [f64; 2]> {
        let windows = (0_u32..).map(f64::from);
        windows
            .zip(values)
            .map(move |(k, value)| [(k + first) * self.window_s, value])
    }
}

fn length<const N: usize>(vector: [f64; N]) -> f64 {
    vector.iter().fold(0.0, |sum: f64, value| sum.hypot(*value))
}

/// A number of windows.
fn as_f64(windows: usize) -> f64 {
    u32::try_from(windows).map_or(f64::INFINITY, f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of sums of a hundred intervals.
    const ROUNDING: f64 = 1e-6;

    /// From rest 100 mm/s along x, then along y, in steps of 0.1 mm, and to rest.
    #[test]
    fn a_corner_is_an_even_speed_and_one_acceleration() {
        let mut sampler = MotionSampler::new([0.0; 2]);
        for k in 1..=400_u32 {
            let mm = f64::from(k) * 0.1;
            sampler.add(f64::from(k) * 0.001, [mm.min(20.0), (mm - 20.0).max(0.0)]);
        }
        let speeds: Vec<_> = sampler.speeds().take(39).collect();
        assert_eq!(speeds.len(), 39);
        assert!(speeds.iter().all(|[_, v]| (v - 100.0).abs() < ROUNDING));
        sampler.end(0.4);
        let changes: Vec<_> = sampler.accelerations().filter(|[_, a]| *a > 1.0).collect();
        // At the corner by 100 mm/s in each direction; at the end of a window or in it.
        let wanted = [1.0, core::f64::consts::SQRT_2, 1.0].map(|v| 100.0 * v / sampler.window_s);
        for ((at, wanted), [t_s, a]) in [0.0, 0.2, 0.4].into_iter().zip(wanted).zip(&changes) {
            assert!((t_s - at).abs() < 0.011, "{changes:?}");
            assert!((a / wanted - 1.0).abs() < ROUNDING, "{changes:?}");
        }
        assert_eq!(changes.len(), 3);
        // At the corner each axis changes its speed by as much as at the ends.
        let mut largest = sampler.axis_accelerations().filter(|[_, a]| *a > 1.0);
        let even = 100.0 / sampler.window_s;
        assert!(largest.all(|[_, a]| (a / even - 1.0).abs() < ROUNDING));
        assert!(sampler.speeds().last().unwrap()[1].abs() < ROUNDING);
    }

    #[test]
    fn windows_are_as_long_as_the_time_asks() {
        for (duration_s, wanted) in [(0.0, 0.01), (18.8, 0.01), (30.0, 0.02), (1000.0, 0.64)] {
            let mut sampler = MotionSampler::new([0.0; 3]);
            sampler.end(duration_s);
            assert!(
                (sampler.window_s() / wanted - 1.0).abs() < ROUNDING,
                "{duration_s} s"
            );
            assert!(sampler.points.len() <= MAX_WINDOWS);
        }
    }
}
