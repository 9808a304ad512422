//! A machine as its user writes it, from the README alone: a parallel SCARA whose pen is beyond the
//! joint of both forearms, on the left one.

use machine_kin::path_timing::{AxisLimits, Curve, Knot, Path, Table};
use machine_kin::{Axis, Machine, MachinePath, Number, Refusal};

use crate::common::{cubics, distance, forward, within};

/// Motors at (-base/2, 0) and (base/2, 0), elbows outwards; lengths in mm.
#[derive(Debug, Clone)]
struct ParallelScara {
    base: f64,
    upper: f64,
    fore: f64,
    /// From the joint to the pen.
    pen: f64,
}

impl ParallelScara {
    /// The upper arm as a vector from its motor, for the other end of the forearm to be at (dx,
    /// dy).
    fn upper_arm<T: Number>(
        &self,
        [dx, dy]: [T; 2],
        fore: f64,
        side: f64,
        reason: &'static str,
    ) -> Result<[T; 2], Refusal> {
        let square = dx.squared() + dy.squared();
        let along = (square + (self.upper * self.upper - fore * fore)) / (2.0 * self.upper);
        let beside = (square - along.squared()).root(reason)? * side;
        let scale = T::from(self.upper) / square;
        Ok([
            (dx * along - dy * beside) * scale,
            (dy * along + dx * beside) * scale,
        ])
    }
}

impl Machine<2> for ParallelScara {
    type Branch = ();

    fn axes(&self) -> [Axis; 2] {
        ["left motor", "right motor"].map(|name| Axis::angle(name, -4.0..=4.0))
    }

    fn inverse<T: Number>(&self, [x, y]: [T; 2], (): ()) -> Result<[T; 2], Refusal> {
        const LEFT: &str = "the left arm is too short or too long";
        const RIGHT: &str = "the right arm is too short or too long";
        let (dx, whole) = (x + self.base / 2.0, self.fore + self.pen);
        let [ex, ey] = self.upper_arm([dx, y], whole, 1.0, LEFT)?;
        let share = self.fore / whole;
        let joint = [ex + (dx - ex) * share - self.base, ey + (y - ey) * share];
        let [fx, fy] = self.upper_arm(joint, self.fore, -1.0, RIGHT)?;
        Ok([T::atan2(ey, ex, LEFT)?, T::atan2(fy, fx, RIGHT)?])
    }
}

#[test]
fn a_machine_of_one_s_own_runs_within_its_bound() {
    let machine = ParallelScara {
        base: 60.0,
        upper: 90.0,
        fore: 130.0,
        pen: 40.0,
    };
    // Its forward kinematics: both forearms have their length.
    let [x, y] = [20.0, 190.0];
    let [left, right] = machine.inverse([x, y], ()).unwrap();
    let elbow = |angle: f64, at: f64| [at + 90.0 * angle.cos(), 90.0 * angle.sin()];
    let (a, b) = (elbow(left, -30.0), elbow(right, 30.0));
    let joint = [0, 1].map(|k| a[k] + ([x, y][k] - a[k]) * (130.0 / 170.0));
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    assert!((length(a, [x, y]) - 170.0).abs() < 1e-9 && (length(b, joint) - 130.0).abs() < 1e-9);
    assert!(a[0] < b[0]);

    let curve = Curve::line([-30.0, 180.0], [40.0, 200.0]).unwrap();
    let path = machine.path(curve, ()).unwrap();
    let motor = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    };
    let mut knots = [Knot::default(); 100];
    let departure = MachinePath::departure;
    let table = Table::plan_within(
        [path.clone()],
        [motor; 2],
        within(0.01),
        departure,
        &mut knots,
    );
    let axes = machine.axes();
    for span in table.unwrap().spans() {
        path.check(&span).unwrap();
        let bound = path.departure(&span);
        for number in 0..=50 {
            let share = f64::from(number) / 50.0;
            let at = span.s[0] + (span.s[1] - span.s[0]) * share;
            let positions = cubics(&span).map(|cubic| cubic.position(share));
            let tool = forward(&machine, &axes, positions, (), curve.at(at).point).unwrap();
            assert!(distance(&curve, tool, at) <= bound.min(0.01) + 1e-9);
        }
    }
    // The left arm of 260 mm is straight before the end.
    let refused = machine.path(Curve::line([0.0, 180.0], [0.0, 300.0]).unwrap(), ());
    let text = refused.unwrap_err().to_string();
    assert!(text.contains("the branch ends where"), "{text}");
}
