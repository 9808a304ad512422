//! What a firmware keeps in memory.

use cortex_m_semihosting::hprintln;

/// A knot of an arm: a name without the `;` that ends a column.
type ArmKnot = path_timing::Knot<[f64; 2]>;

/// Says the bytes of each type.
pub fn say() {
    macro_rules! say {
        ($($kind:ty),* $(,)?) => {
            $(hprintln!("{};bytes;{}", stringify!($kind), size_of::<$kind>());)*
        };
    }
    use motor_phases::Accumulators;
    use path_timing::FeedCeiling;
    use pvt_steps::{AxisRamp, AxisSegments, JoinedSegments, PvtSteps, Segment, SegmentPlayer};
    use stepper_sync::{AxisTrain, Edges};
    say!(
        scara_kin::Arm<f32>,
        scara_kin::Arm<f64>,
        delta_kin::Delta<f32>,
        delta_kin::Delta<f64>,
        pose_pt::Platform<3, f32>,
        pose_pt::Platform<3, f64>,
        ArmKnot,
        FeedCeiling,
        PvtSteps<2>,
        AxisSegments,
        JoinedSegments,
        Segment,
        SegmentPlayer,
        AxisTrain,
        AxisRamp,
        Edges<AxisTrain, 2>,
        Edges<AxisRamp, 2>,
        Accumulators<8>,
        pulse_interp::LineSteps,
        pulse_interp::ArcSteps,
        pulse_interp::ArcMoves,
        proto3964r::Station<128>,
        rk512::Client<128>,
        rk512::Server,
        handwheel::Driver,
    );
}
