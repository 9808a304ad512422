//! Every public function of the crate but those of paths and tables as one of numbers, in f64 and
//! in f32.

use pose_pt::nalgebra::{
    Isometry3, Matrix3, Point3, Quaternion, RealField, Rotation3, UnitQuaternion, Vector3,
};
use pose_pt::{
    Convention, Locator, LocatorAxis, Platform, PoseVector, Trig, angle_between, calibrate,
    from_matrix, from_rotation_vector, rigid_fit, rotation_vector, rotation_vector_between, slerp,
    to_matrix,
};

/// All numbers that came out, or the message of the error.
pub(crate) type Outcome<T> = Result<Vec<T>, String>;

/// A function, and what it can be called with.
pub(crate) struct Call<T> {
    pub(crate) name: &'static str,
    pub(crate) good: Vec<T>,
    pub(crate) run: fn(&mut Inputs<'_, T>) -> Outcome<T>,
}

/// Numbers that are taken one after the other.
pub(crate) struct Inputs<'a, T>(core::slice::Iter<'a, T>);

impl<'a, T: RealField + Trig> Inputs<'a, T> {
    pub(crate) fn new(numbers: &'a [T]) -> Self {
        Self(numbers.iter())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.len() == 0
    }

    pub(crate) fn next(&mut self) -> T {
        *self.0.next().unwrap()
    }

    pub(crate) fn vector(&mut self) -> Vector3<T> {
        Vector3::new(self.next(), self.next(), self.next())
    }

    fn point(&mut self) -> Point3<T> {
        self.vector().into()
    }

    fn points<const N: usize>(&mut self) -> [Point3<T>; N] {
        [(); N].map(|()| self.point())
    }

    pub(crate) fn vectors<const N: usize>(&mut self) -> [Vector3<T>; N] {
        [(); N].map(|()| self.vector())
    }

    fn matrix(&mut self) -> Matrix3<T> {
        Matrix3::from_columns(&self.vectors::<3>())
    }

    /// As it stands there, of any length.
    fn rotation(&mut self) -> UnitQuaternion<T> {
        let (w, v) = (self.next(), self.vector());
        UnitQuaternion::new_unchecked(Quaternion::from_parts(w, v))
    }

    pub(crate) fn pose(&mut self) -> Isometry3<T> {
        Isometry3::from_parts(self.vector().into(), self.rotation())
    }

    pub(crate) fn pose_vector(&mut self) -> PoseVector<T> {
        let (p, a) = (self.vector(), self.vector());
        PoseVector::new(p.x, p.y, p.z, a.x, a.y, a.z)
    }

    fn limits(&mut self) -> LocatorAxis<T> {
        let [min, max, speed] = [(); 3].map(|()| self.next());
        LocatorAxis {
            min,
            max,
            speed,
            acceleration: self.next(),
            jerk: Some(self.next()),
        }
    }

    pub(crate) fn platform(&mut self) -> Result<Platform<3, T>, String> {
        let locators = [(); 3].map(|()| {
            let (anchor, origin, axes) = (self.point(), self.point(), self.matrix());
            let limits = [(); 3].map(|()| self.limits());
            Locator::new(anchor, origin, limits).with_axes(axes)
        });
        Platform::new(locators).map_err(message)
    }
}

pub(crate) fn message(error: impl core::fmt::Display) -> String {
    error.to_string()
}

pub(crate) fn flat<const N: usize, T: RealField + Trig>(vectors: &[Vector3<T>; N]) -> Vec<T> {
    vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

fn flat_points<const N: usize, T: RealField + Trig>(points: &[Point3<T>; N]) -> Vec<T> {
    flat(&points.map(|point| point.coords))
}

fn of_rotation<T: RealField + Trig>(rotation: &UnitQuaternion<T>) -> Vec<T> {
    rotation.coords.iter().copied().collect()
}

pub(crate) fn of_pose<T: RealField + Trig>(pose: &Isometry3<T>) -> Vec<T> {
    [
        pose.translation.vector.as_slice(),
        pose.rotation.coords.as_slice(),
    ]
    .concat()
}

fn of_vector<T: RealField + Trig>(vector: &PoseVector<T>) -> Vec<T> {
    [vector.position().as_slice(), vector.angles().as_slice()].concat()
}

pub(crate) const CONVENTIONS: [Convention; 2] =
    [Convention::ExtrinsicXyz, Convention::IntrinsicXyz];

const ANCHORS: [[f64; 3]; 3] = [[-15.0, -10.0, 1.0], [15.0, -11.0, 0.5], [2.0, 10.0, -0.7]];
const QUATERNION: [f64; 4] = [0.8, 0.48, -0.288, 0.216];
const OTHER: [f64; 4] = [0.96, -0.168, 0.1792, 0.134_4];
pub(crate) const TRANSLATION: [f64; 3] = [1.5, -0.25, 0.75];
pub(crate) const ANGLES: [f64; 3] = [0.3, -0.2, 0.7];

/// A good platform of 90 numbers.
pub(crate) fn platform() -> Vec<f64> {
    let axes = [
        1.0, 0.002, -0.001, 0.003, 0.999, 0.002, 0.001, -0.002, 1.001,
    ];
    let limits = [-30.0, 40.0, 2.0, 5.0, 40.0];
    let locator = |anchor: [f64; 3]| {
        let origin = anchor.map(|x| x + 0.125);
        [&anchor[..], &origin, &axes, &limits, &limits, &limits].concat()
    };
    ANCHORS.map(locator).concat()
}

pub(crate) fn two_poses() -> Vec<f64> {
    [&TRANSLATION[..], &QUATERNION, &[-0.5, 0.5, 0.25], &OTHER].concat()
}

/// All functions but those of paths and tables.
pub(crate) fn all<T: RealField + Trig>() -> Vec<Call<T>> {
    let call = |name, good: &[&[f64]], run| Call {
        name,
        good: good.concat().iter().map(|x| T::from_subset(x)).collect(),
        run,
    };
    let platform = &platform();
    vec![
        call("PoseVector::to_*", &[&TRANSLATION, &ANGLES], |x| {
            let vector = x.pose_vector();
            let mut all = of_vector(&vector);
            for convention in CONVENTIONS {
                all.extend(of_pose(&vector.to_isometry(convention)));
                all.extend(of_rotation(&vector.to_quaternion(convention)));
                all.extend(vector.to_rotation(convention).matrix().iter());
            }
            Ok(all)
        }),
        call(
            "PoseVector::from_isometry*",
            &[&TRANSLATION, &QUATERNION, &TRANSLATION, &ANGLES],
            |x| {
                let (pose, previous) = (x.pose(), x.pose_vector());
                let mut all = of_vector(&previous);
                for convention in CONVENTIONS {
                    let found = PoseVector::from_isometry(&pose, convention);
                    all.extend(of_vector(&found.vector));
                    all.push(found.cos_beta);
                    let near = PoseVector::from_isometry_near(&pose, convention, &previous);
                    all.extend(of_vector(&near.vector));
                }
                Ok(all)
            },
        ),
        call("slerp", &[&QUATERNION, &OTHER, &[0.3]], |x| {
            let (a, b) = (x.rotation(), x.rotation());
            Ok(of_rotation(&slerp(&a, &b, x.next())))
        }),
        call("rotations between", &[&QUATERNION, &OTHER], |x| {
            let (a, b) = (x.rotation(), x.rotation());
            let between = rotation_vector_between(&a, &b);
            Ok([&[angle_between(&a, &b)], between.as_slice()].concat())
        }),
        call("rotation_vector", &[&QUATERNION], |x| {
            Ok(rotation_vector(&x.rotation()).as_slice().to_vec())
        }),
        call("to_matrix", &[&QUATERNION], |x| {
            Ok(to_matrix(&x.rotation()).matrix().as_slice().to_vec())
        }),
        call("from_rotation_vector", &[&ANGLES], |x| {
            Ok(of_rotation(&from_rotation_vector(&x.vector())))
        }),
        call(
            "from_matrix",
            &[&[0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0]],
            |x| {
                let matrix = x.matrix();
                let rotation = from_matrix(&matrix, T::from_subset(&1e-3)).map_err(message)?;
                Ok(of_rotation(&rotation))
            },
        ),
        call(
            "rigid_fit",
            &[
                &ANCHORS.concat(),
                &[1.0, 2.0, 12.0],
                &ANCHORS.concat(),
                &[1.5, 2.5, 12.5],
            ],
            |x| {
                let (from, to) = (x.points::<4>(), x.points::<4>());
                let fit = rigid_fit(&from, &to).map_err(message)?;
                let mut all = of_pose(&fit.motion);
                all.extend([fit.rms, fit.max_residual, fit.eigenvalue_gap]);
                all.extend(fit.residual(&from[0], &to[0]).iter());
                Ok(all)
            },
        ),
        call(
            "calibrate",
            &[
                &[
                    0.0, 0.0, 0.5, 9.0, 0.5, 0.0, 0.5, 8.0, 0.0, 0.5, 0.5, 7.0, 3.0, 3.0, 3.0,
                ],
                &[
                    1.0, 2.0, 3.5, 10.0, 2.5, 3.0, 1.5, 10.0, 3.0, 1.5, 2.5, 10.0, 4.0, 5.0, 6.0,
                ],
            ],
            |x| {
                let (positions, points) = (x.vectors::<5>(), x.points::<5>());
                let frame = calibrate(&positions, &points).map_err(message)?;
                let mut all = [frame.origin.coords.as_slice(), frame.axes.as_slice()].concat();
                all.extend([frame.rms, frame.max_residual]);
                all.extend(frame.scales().iter());
                all.extend(frame.squareness_errors().iter());
                Ok(all)
            },
        ),
        call(
            "Platform of poses",
            &[platform, &TRANSLATION, &QUATERNION],
            |x| {
                let platform = x.platform()?;
                let pose = x.pose();
                let mut all = flat(&platform.checked_axes(&pose).map_err(message)?);
                all.extend(flat_points(&platform.positions(&pose)));
                all.push(platform.largest_anchor_distance());
                Ok(all)
            },
        ),
        call(
            "Platform of motions",
            &[
                &TRANSLATION,
                &QUATERNION,
                &[0.1, 0.2, 0.3],
                &[0.3, 0.2, 0.1],
                &[0.2, 0.4, 0.6],
            ],
            |x| {
                let platform = good_platform::<T>();
                let (pose, linear) = (x.pose(), x.vector());
                let (angular, angular_acceleration) = (x.vector(), x.vector());
                let velocities = platform.axis_velocities(&pose, &linear, &angular);
                let accelerations =
                    platform.axis_accelerations(&pose, &linear, &angular, &angular_acceleration);
                let translation = pose.translation.vector;
                let rotation: Rotation3<T> = to_matrix(&pose.rotation);
                let axes = platform.axes_at(&rotation, &translation);
                Ok([flat(&velocities), flat(&accelerations), flat(&axes)].concat())
            },
        ),
        call(
            "Platform of axes",
            &[&[0.5, -1.0, 2.0, 0.75, -1.25, 2.5, 0.25, -0.75, 2.25]],
            |x| {
                let (platform, axes) = (good_platform::<T>(), x.vectors::<3>());
                platform.check_axes(&axes).map_err(message)?;
                let body = platform.pose(&axes).map_err(message)?;
                let mut all = of_pose(&body.pose);
                all.extend(flat(&body.residuals));
                all.extend([
                    body.rms,
                    body.distance_error.distance,
                    body.distance_error.change,
                ]);
                Ok(all)
            },
        ),
        call("Platform of points", &[&ANCHORS.concat()], |x| {
            let (platform, points) = (good_platform::<T>(), x.points::<3>());
            let body = platform.pose_of_points(&points).map_err(message)?;
            Ok([of_pose(&body.pose), vec![body.distance_error.change]].concat())
        }),
        call("Platform::distance_error", &[&ANCHORS.concat()], |x| {
            Ok(vec![
                good_platform::<T>().distance_error(&x.points()).change,
            ])
        }),
        call("Platform::locator_positions", &[&ANCHORS.concat()], |x| {
            Ok(flat_points(
                &good_platform::<T>().locator_positions(&x.vectors()),
            ))
        }),
    ]
}

fn good_platform<T: RealField + Trig>() -> Platform<3, T> {
    let numbers: Vec<T> = platform().iter().map(|x| T::from_subset(x)).collect();
    Inputs::new(&numbers).platform().unwrap()
}
