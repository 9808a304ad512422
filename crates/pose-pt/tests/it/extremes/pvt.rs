//! The functions of PVT tables as functions of numbers.

use crate::support::table::{BodyTable, Cut, bound, plan, points_of};
use path_timing::{FeedCeiling, Knot};
use pose_pt::nalgebra::Vector3;
use pose_pt::{Blend, Interpolation, Platform, PosePath, hermite_distance_error};

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
        call("PVT", &[platform, poses, &[0.05]], |x| {
            let (platform, poses) = (x.platform()?, [x.pose(), x.pose()]);
            let path = PosePath::new(&poses, Interpolation::Screw).map_err(message)?;
            let mut knots = [Knot::default(); 200];
            let table = plan(&platform, &path, Cut::Within(x.next()), &mut knots);
            let table = table.map_err(message)?;
            let mut all = vec![table.duration_s(), bound(&platform, &table)];
            for point in points_of(table.rows()) {
                all.extend([point.time_s, point.segment_s]);
                all.extend(flat(&point.axes));
                all.extend(flat(&point.velocities));
            }
            Ok(all)
        }),
        call(
            "PVT with blends",
            &[platform, poses, &[0.5, 1.0, -0.75], &THIRD, &[0.25, 0.05]],
            |x| {
                let (platform, poses) = (x.platform()?, [x.pose(), x.pose(), x.pose()]);
                let blend = Blend {
                    distance: x.next(),
                    rotation_rad: x.next(),
                };
                let path = PosePath::new(&poses, Interpolation::Straight).map_err(message)?;
                let blends = [blend];
                let path = path.with_blends(&blends).map_err(message)?;
                let mut knots = [Knot::default(); 40];
                let table = plan(&platform, &path, Cut::Into(12), &mut knots).map_err(message)?;
                let mut all = vec![table.duration_s()];
                for point in points_of(table.rows()) {
                    all.extend(flat(&point.axes));
                    all.extend(flat(&point.velocities));
                }
                Ok(all)
            },
        ),
        call("Playback", &[&[0.75, 1.25, 0.5, 1.125]], |x| {
            with_table(|_, table| {
                let table = table.at_speed(x.next()).map_err(message)?;
                let mut ceilings = [FeedCeiling::default(); 21];
                let mut run = table.playback(x.next(), &mut ceilings).map_err(message)?;
                let mut all = Vec::new();
                for _ in 0..2 {
                    run.set_feed(x.next()).map_err(message)?;
                    for point in points_of(run.by_ref().take(11)) {
                        all.extend([point.time_s, point.segment_s]);
                        all.extend(flat(&point.velocities));
                    }
                }
                Ok(all)
            })
        }),
        call("hermite_distance_error", &[&[0.01; 36], &[0.25]], |x| {
            with_table(|platform, table| {
                let mut rows = table.spans().next().unwrap().rows;
                for row in &mut rows {
                    let each = row.position.iter_mut().zip(&mut row.velocity);
                    for (position, velocity) in each {
                        *position = (Vector3::from(*position) + x.vector()).into();
                        *velocity = (Vector3::from(*velocity) + x.vector()).into();
                    }
                }
                rows[1].duration_s = x.next();
                Ok(vec![hermite_distance_error(platform, &rows)])
            })
        }),
    ]
}

/// A table of 20 segments on the good platform.
fn with_table(run: impl FnOnce(&Platform<3>, BodyTable<'_, 3>) -> Outcome<f64>) -> Outcome<f64> {
    let numbers = [platform(), two_poses()].concat();
    let mut inputs = crate::extremes::calls::Inputs::new(&numbers);
    let (platform, poses) = (inputs.platform()?, [inputs.pose(), inputs.pose()]);
    let path = PosePath::new(&poses, Interpolation::Straight).map_err(message)?;
    let mut knots = [Knot::default(); 21];
    let table = plan(&platform, &path, Cut::Into(20), &mut knots).map_err(message)?;
    run(&platform, table)
}
