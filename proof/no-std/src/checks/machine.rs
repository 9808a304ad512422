//! A machine by its inverse alone: a line of a five-bar, planned within its bound, and what is
//! refused.

use machine_kin::{Elbow, FiveBar, Machine, MachinePath, PathError};
use path_timing::{Accuracy, AxisLimits, Curve, Knot, Table};

pub fn path() -> Option<()> {
    let machine = FiveBar::new(80.0, 100.0, 160.0).ok()?;
    let outwards = [Elbow::Left, Elbow::Right];
    let line = Curve::line([-60.0, 150.0], [60.0, 180.0]).ok()?;
    let path = machine.path(line, outwards).ok()?;
    let motor = AxisLimits {
        speed: 6.0,
        acceleration: 100.0,
        jerk: None,
    };
    let accuracy = Accuracy {
        min_segments: 8,
        max_departure: 0.01,
        max_time_ratio: f64::INFINITY,
    };
    let mut knots = [Knot::default(); 60];
    let departure = MachinePath::departure;
    let table = Table::plan_within([path], [motor; 2], accuracy, departure, &mut knots).ok()?;
    let down = Curve::line([0.0, 200.0], [0.0, 20.0]).ok()?;
    let refused = machine.path(down, outwards);
    let is_known =
        matches!(refused, Err(PathError::BranchEnds { s, .. }) if s > 155.0 && s < 156.0);
    (table.len() > 8 && is_known).then_some(())
}
