//! The functions of paths and PT tables as functions of numbers.

use pose_pt::{Convention, Interpolation, PosePath, PtTable, Segmentation};

use crate::extremes::calls::{
    ANGLES, CONVENTIONS, Call, TRANSLATION, flat, message, of_pose, platform, two_poses,
};

const KINDS: [Interpolation; 4] = [
    Interpolation::Straight,
    Interpolation::Screw,
    Interpolation::Vector(Convention::ExtrinsicXyz),
    Interpolation::Vector(Convention::IntrinsicXyz),
];

/// All functions of paths and PT tables.
pub(crate) fn all() -> Vec<Call<f64>> {
    let call = |name, good: &[&[f64]], run| Call {
        name,
        good: good.concat(),
        run,
    };
    let platform = &platform();
    vec![
        call("PosePath of poses", &[&two_poses(), &[0.375]], |x| {
            let (poses, s) = ([x.pose(), x.pose()], x.next());
            let mut all = Vec::new();
            for kind in KINDS {
                let leg = PosePath::new(&poses, kind)
                    .map_err(message)?
                    .leg(0)
                    .unwrap();
                all.extend(of_pose(&leg.pose(s)));
                all.extend([leg.turn(), leg.length()]);
            }
            Ok(all)
        }),
        call(
            "PosePath of vectors",
            &[
                &TRANSLATION,
                &ANGLES,
                &[0.5, 0.25, 1.0],
                &[1.0, -2.0, 9.0],
                &[0.375],
            ],
            |x| {
                let (vectors, s) = ([x.pose_vector(), x.pose_vector()], x.next());
                let mut all = Vec::new();
                for convention in CONVENTIONS {
                    let path = PosePath::of_vectors(&vectors, convention).map_err(message)?;
                    let leg = path.leg(0).unwrap();
                    all.extend(of_pose(&leg.pose(s)));
                    all.extend([leg.turn(), leg.length()]);
                }
                Ok(all)
            },
        ),
        call(
            "PtTable",
            &[platform, &two_poses(), &[0.5, 0.1, 0.05]],
            |x| {
                let (platform, poses) = (x.platform()?, [x.pose(), x.pose()]);
                let segmentations = [
                    Segmentation::steps(x.next(), x.next()),
                    Segmentation::max_distance_error(x.next()),
                ];
                let mut all = Vec::new();
                for kind in KINDS {
                    let path = PosePath::new(&poses, kind).map_err(message)?;
                    for segmentation in segmentations {
                        let table =
                            PtTable::plan(&platform, &path, segmentation).map_err(message)?;
                        all.extend([table.duration_s(), table.distance_error_bound()]);
                        for point in table.points() {
                            all.extend([point.time_s, point.segment_s]);
                            all.extend(flat(&point.axes));
                        }
                    }
                }
                Ok(all)
            },
        ),
    ]
}
