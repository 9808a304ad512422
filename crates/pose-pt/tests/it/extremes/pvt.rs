//! The functions of PVT tables as functions of numbers.

use pose_pt::{
    Blend, FeedCeiling, Interpolation, Knot, Path, PvtTable, Segmentation, hermite_distance_error,
};

use crate::extremes::calls::{Call, Outcome, flat, message, platform, two_poses};

/// A third rotation.
const THIRD: [f64; 4] = [0.96, 0.168, -0.1792, 0.134_4];

/// All functions of PVT tables.
pub(crate) fn all() -> Vec<Call<f64>> {
    let call = |name, good: &[&[f64]], run| Call {
        name,
        good: good.concat(),
        run,
    };
    let (platform, poses) = (&platform(), &two_poses());
    vec![
        call("PvtTable", &[platform, poses, &[0.5, 0.1, 0.05]], |x| {
            let (platform, poses) = (x.platform()?, [x.pose(), x.pose()]);
            let segmentations = [
                Segmentation::steps(x.next(), x.next()),
                Segmentation::max_distance_error(x.next()),
            ];
            let mut all = Vec::new();
            for segmentation in segmentations {
                let path = Path::new(&poses, Interpolation::Screw).map_err(message)?;
                let mut knots = [Knot::default(); 200];
                let table =
                    PvtTable::plan(&platform, &path, segmentation, &mut knots).map_err(message)?;
                all.extend([table.duration_s(), table.distance_error_bound()]);
                for point in table.points() {
                    all.extend([point.time_s, point.segment_s]);
                    all.extend(flat(&point.axes));
                    all.extend(flat(&point.velocities));
                }
            }
            Ok(all)
        }),
        call(
            "PvtTable with blends",
            &[platform, poses, &[0.5, 1.0, -0.75], &THIRD, &[0.25, 0.05]],
            |x| {
                let (platform, poses) = (x.platform()?, [x.pose(), x.pose(), x.pose()]);
                let blend = Blend {
                    distance: x.next(),
                    rotation_rad: x.next(),
                };
                let path = Path::new(&poses, Interpolation::Straight).map_err(message)?;
                let blends = [blend];
                let path = path.with_blends(&blends).map_err(message)?;
                let mut knots = [Knot::default(); 40];
                let table =
                    PvtTable::plan(&platform, &path, Segmentation::segments(12), &mut knots)
                        .map_err(message)?;
                let mut all = vec![table.duration_s()];
                for point in table.points() {
                    all.extend(flat(&point.axes));
                    all.extend(flat(&point.velocities));
                }
                Ok(all)
            },
        ),
        call("PvtRun", &[&[0.75, 1.25, 0.5, 1.125]], |x| {
            with_table(|table| {
                let table = table.at_speed_scale(x.next()).map_err(message)?;
                let mut ceilings = [FeedCeiling::default(); 21];
                let mut run = table.run(x.next(), &mut ceilings).map_err(message)?;
                let mut all = Vec::new();
                for _ in 0..2 {
                    run.set_feed(x.next()).map_err(message)?;
                    for point in run.by_ref().take(11) {
                        all.extend([point.time_s, point.segment_s]);
                        all.extend(flat(&point.velocities));
                    }
                }
                Ok(all)
            })
        }),
        call("hermite_distance_error", &[&[0.01; 36], &[0.25]], |x| {
            with_table(|table| {
                let mut points = table.points();
                let (mut from, mut to) = (points.next().unwrap(), points.next().unwrap());
                for point in [&mut from, &mut to] {
                    for (axes, velocities) in point.axes.iter_mut().zip(&mut point.velocities) {
                        *axes += x.vector();
                        *velocities += x.vector();
                    }
                }
                to.segment_s = x.next();
                Ok(vec![hermite_distance_error(table.platform(), &from, &to)])
            })
        }),
    ]
}

/// A table of 20 segments on the good platform.
fn with_table(run: impl FnOnce(PvtTable<'_, 3>) -> Outcome<f64>) -> Outcome<f64> {
    let numbers = [platform(), two_poses()].concat();
    let mut inputs = crate::extremes::calls::Inputs::new(&numbers);
    let (platform, poses) = (inputs.platform()?, [inputs.pose(), inputs.pose()]);
    let path = Path::new(&poses, Interpolation::Straight).map_err(message)?;
    let mut knots = [Knot::default(); 21];
    run(
        PvtTable::plan(&platform, &path, Segmentation::segments(20), &mut knots)
            .map_err(message)?,
    )
}
