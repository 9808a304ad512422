//! Speed and acceleration of the platform over time, from where it is at each step.

use nalgebra::{Point3, Vector3};

/// Shorter windows show single steps.
const MIN_WINDOW_S: f64 = 0.01;
const MAX_WINDOWS: f64 = 512.0;

/// Where the platform is at the ends of windows of equal length.
#[derive(Debug, Clone)]
pub(crate) struct Sampler {
    pub(crate) window_s: f64,
    points: Vec<Point3<f64>>,
    /// Windows that have ended.
    ended: u32,
    last: (f64, Point3<f64>),
}

impl Sampler {
    /// A sampler for a duration, from a point on.
    pub(crate) fn new(duration_s: f64, start: Point3<f64>) -> Self {
        let mut window_s = MIN_WINDOW_S;
        while duration_s > MAX_WINDOWS * window_s {
            window_s *= 2.0;
        }
        Self {
            window_s,
            points: vec![start],
            ended: 0,
            last: (0.0, start),
        }
    }

    /// The platform is at a point at a time; between two points it moves evenly.
    pub(crate) fn add(&mut self, t_s: f64, point: Point3<f64>) {
        let (last_s, last) = self.last;
        loop {
            let end_s = f64::from(self.ended + 1) * self.window_s;
            if end_s > t_s {
                break;
            }
            let fraction = (end_s - last_s) / (t_s - last_s);
            self.points.push(last + (point - last) * fraction);
            self.ended += 1;
        }
        self.last = (t_s, point);
    }

    /// From a time on it stands where it is: one more window, at least.
    pub(crate) fn end(&mut self, t_s: f64) {
        let (_, last) = self.last;
        self.add(t_s + 2.0 * self.window_s, last);
    }

    /// Time in s and mean speed in mm/s of each window.
    pub(crate) fn speeds(&self) -> impl Iterator<Item = [f64; 2]> {
        let velocities = self.velocities().map(|velocity| velocity.norm());
        self.over_time(0.5, velocities)
    }

    /// Time in s, and the change of the velocity from one window to the next over the time between
    /// them, in mm/s²; it starts from rest.
    pub(crate) fn accelerations(&self) -> impl Iterator<Item = [f64; 2]> {
        let before = core::iter::once(Vector3::zeros()).chain(self.velocities());
        let changes = before.zip(self.velocities());
        let changes = changes.map(|(a, b)| (b - a).norm() / self.window_s);
        self.over_time(0.0, changes)
    }

    fn velocities(&self) -> impl Iterator<Item = Vector3<f64>> {
        let ends = self.points.iter().zip(self.points.iter().skip(1));
        ends.map(|(a, b)| (b - a) / self.window_s)
    }

    /// Values of one window after the other, the first after so many windows.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of sums of a hundred intervals.
    const ROUNDING: f64 = 1e-6;

    /// From rest 100 mm/s along x, then along y, in steps of 0.1 mm, and to rest.
    #[test]
    fn a_corner_is_an_even_speed_and_one_acceleration() {
        let mut sampler = Sampler::new(0.4, Point3::origin());
        for k in 1..=400_u32 {
            let mm = f64::from(k) * 0.1;
            let point = Point3::new(mm.min(20.0), (mm - 20.0).max(0.0), 0.0);
            sampler.add(f64::from(k) * 0.001, point);
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
        assert!(sampler.speeds().last().unwrap()[1].abs() < ROUNDING);
    }

    #[test]
    fn windows_are_as_long_as_the_duration_asks() {
        let windows = |duration_s| Sampler::new(duration_s, Point3::origin()).window_s;
        let wanted = [0.01, 0.02, 2.56];
        for (duration_s, wanted) in [0.0, 9.4, 1000.0].into_iter().zip(wanted) {
            assert!((windows(duration_s) - wanted).abs() < ROUNDING);
        }
    }
}
