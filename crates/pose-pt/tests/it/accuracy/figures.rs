//! The errors that the documentation gives a bound of.

use core::f64::consts::{FRAC_PI_2, PI};

use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};
use pose_pt::{
    Convention, Locator, LocatorAxis, Platform, PoseVector, angle_between, from_rotation_vector,
    rigid_fit, slerp, to_matrix,
};
use twofloat::TwoFloat;

use crate::accuracy::search::Draw;

type Matrix = [[TwoFloat; 3]; 3];
type Vector = [TwoFloat; 3];

fn exact(value: f64) -> TwoFloat {
    TwoFloat::from(value)
}

/// In machine epsilons.
fn epsilons(error: TwoFloat) -> f64 {
    f64::from(error).abs() / f64::EPSILON
}

fn length<const N: usize>(vector: [TwoFloat; N]) -> TwoFloat {
    vector
        .iter()
        .fold(exact(0.0), |sum, x| sum + *x * *x)
        .sqrt()
}

fn times(m: &Matrix, v: &Vector3<f64>) -> Vector {
    m.map(|[x, y, z]| x * v.x + y * v.y + z * v.z)
}

fn less<const N: usize>(a: [TwoFloat; N], b: [TwoFloat; N]) -> [TwoFloat; N] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn rounded(v: Vector) -> Vector3<f64> {
    Vector3::from(v.map(f64::from))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    })
}

/// The rotation about X, Y or Z.
fn about(axis: usize, angle: f64) -> Matrix {
    let (sin, cos) = exact(angle).sin_cos();
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = [[exact(0.0); 3]; 3];
    m[axis][axis] = exact(1.0);
    (m[next][next], m[last][last]) = (cos, cos);
    (m[next][last], m[last][next]) = (-sin, sin);
    m
}

fn of_angles(vector: &PoseVector, convention: Convention) -> Matrix {
    let [x, y, z] = [(0, vector.alpha), (1, vector.beta), (2, vector.gamma)]
        .map(|(axis, angle)| about(axis, angle));
    match convention {
        Convention::ExtrinsicXyz => product(&z, &product(&y, &x)),
        _ => product(&x, &product(&y, &z)),
    }
}

fn of_quaternion(q: &UnitQuaternion<f64>) -> Matrix {
    let [x, y, z, w] = [q.i, q.j, q.k, q.w].map(exact);
    let s = exact(2.0) / (x * x + y * y + z * z + w * w);
    let one = exact(1.0);
    [
        [
            one - s * (y * y + z * z),
            s * (x * y - z * w),
            s * (x * z + y * w),
        ],
        [
            s * (x * y + z * w),
            one - s * (x * x + z * z),
            s * (y * z - x * w),
        ],
        [
            s * (x * z - y * w),
            s * (y * z + x * w),
            one - s * (x * x + y * y),
        ],
    ]
}

fn worst_entry(found: &Matrix3<f64>, wanted: &Matrix) -> f64 {
    let entries = (0..9).map(|n| epsilons(wanted[n / 3][n % 3] - found[(n / 3, n % 3)]));
    entries.fold(0.0, f64::max)
}

/// Angles all over, some of them near gimbal lock.
fn angles(draw: &mut Draw) -> (PoseVector, Convention) {
    let near = FRAC_PI_2 - draw.size(-17.0, 0.0);
    let beta = match (draw.is_true(), draw.is_true()) {
        (true, true) => near,
        (true, false) => -near,
        _ => draw.within(-FRAC_PI_2, FRAC_PI_2),
    };
    let vector = PoseVector::new(
        0.0,
        0.0,
        0.0,
        draw.within(-PI, PI),
        beta,
        draw.within(-PI, PI),
    );
    let convention = if draw.is_true() {
        Convention::ExtrinsicXyz
    } else {
        Convention::IntrinsicXyz
    };
    (vector, convention)
}

fn rotation(draw: &mut Draw) -> Option<UnitQuaternion<f64>> {
    let [w, x, y, z] = [(); 4].map(|()| draw.within(-1.0, 1.0));
    UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.1)
}

fn vector(draw: &mut Draw, size: f64) -> Vector3<f64> {
    Vector3::from([(); 3].map(|()| draw.within(-size, size)))
}

pub(crate) fn matrix_of_angles(draw: &mut Draw) -> Option<f64> {
    let (vector, convention) = angles(draw);
    let matrix = vector.to_rotation(convention);
    Some(worst_entry(
        matrix.matrix(),
        &of_angles(&vector, convention),
    ))
}

pub(crate) fn matrix_through_quaternion(draw: &mut Draw) -> Option<f64> {
    let (vector, convention) = angles(draw);
    let matrix = to_matrix(&vector.to_quaternion(convention));
    Some(worst_entry(
        matrix.matrix(),
        &of_angles(&vector, convention),
    ))
}

pub(crate) fn matrix_rebuilt(draw: &mut Draw) -> Option<f64> {
    let (vector, convention) = angles(draw);
    let found = PoseVector::from_isometry(&vector.to_isometry(convention), convention);
    let matrix = found.vector.to_rotation(convention);
    Some(worst_entry(
        matrix.matrix(),
        &of_angles(&vector, convention),
    ))
}

/// Errors of α and γ times cos β.
pub(crate) fn angles_at_their_lever(draw: &mut Draw) -> Option<f64> {
    let (vector, convention) = angles(draw);
    let found = PoseVector::from_isometry(&vector.to_isometry(convention), convention);
    if found.locked {
        return None;
    }
    let off = |found: f64, given: f64| {
        // Sine and cosine of the difference: whole turns do not count.
        let (sin, cos) = (exact(found) - given).sin_cos();
        f64::from(sin).atan2(f64::from(cos)).abs()
    };
    let alpha = off(found.vector.alpha, vector.alpha);
    let worst = alpha.max(off(found.vector.gamma, vector.gamma));
    Some(worst * vector.beta.cos() / f64::EPSILON)
}

/// Two rotations, some of them close, as unit quaternions on the shorter arc.
fn two_rotations(draw: &mut Draw) -> Option<[UnitQuaternion<f64>; 2]> {
    let (a, other, is_close) = (rotation(draw)?, rotation(draw)?, draw.is_true());
    let axis = vector(draw, 1.0).try_normalize(0.1)?;
    let close = from_rotation_vector(&(axis * draw.size(-12.0, 0.4))) * a;
    Some([a, if is_close { close } else { other }])
}

/// Both quaternions at length 1 and on the shorter arc, and half of the angle between them.
fn arc([a, b]: &[UnitQuaternion<f64>; 2]) -> ([[TwoFloat; 4]; 2], TwoFloat) {
    let [a, b] = [a, b].map(|q| {
        let all = [q.i, q.j, q.k, q.w].map(exact);
        let length = length(all);
        all.map(|x| x / length)
    });
    let dot = (0..4).fold(exact(0.0), |sum, i| sum + a[i] * b[i]);
    let b = if f64::from(dot) < 0.0 {
        b.map(|x| -x)
    } else {
        b
    };
    let sum = core::array::from_fn(|i| a[i] + b[i]);
    let angle = exact(2.0) * length(less(b, a)).atan2(length::<4>(sum));
    ([a, b], angle)
}

pub(crate) fn slerp_between(draw: &mut Draw) -> Option<f64> {
    let rotations = two_rotations(draw)?;
    let t = draw.within(0.0, 1.0);
    let found = slerp(&rotations[0], &rotations[1], t);
    let ([a, b], angle) = arc(&rotations);
    let sin = angle.sin();
    if f64::from(sin) <= 0.0 {
        return None;
    }
    let from = (angle * (exact(1.0) - t)).sin() / sin;
    let to = (angle * t).sin() / sin;
    let wanted = core::array::from_fn(|i| a[i] * from + b[i] * to);
    let found = [found.i, found.j, found.k, found.w].map(exact);
    let off = [found, found.map(|x| -x)].map(|found| epsilons(length::<4>(less(found, wanted))));
    Some(off[0].min(off[1]))
}

/// Relative error. The angle is that of b a*, for which no length is divided by.
pub(crate) fn angle_between_close(draw: &mut Draw) -> Option<f64> {
    let rotations = two_rotations(draw)?;
    let [(aw, [ax, ay, az]), (bw, [bx, by, bz])] = rotations
        .each_ref()
        .map(|q| (exact(q.w), [q.i, q.j, q.k].map(exact)));
    let scalar = aw * bw + ax * bx + ay * by + az * bz;
    let sine = length([
        aw * bx - bw * ax + az * by - ay * bz,
        aw * by - bw * ay + ax * bz - az * bx,
        aw * bz - bw * az + ay * bx - ax * by,
    ]);
    let half = sine.atan2(scalar.abs());
    if f64::from(half) <= 0.0 {
        return None;
    }
    let angle = half + half;
    let found = angle_between(&rotations[0], &rotations[1]);
    Some(epsilons((exact(found) - angle) / angle))
}

struct Body {
    platform: Platform<3>,
    pose: Isometry3<f64>,
    matrix: Matrix,
}

impl Body {
    fn new(draw: &mut Draw) -> Option<Self> {
        let limits = [LocatorAxis {
            min: -1.0,
            max: 1.0,
            speed: 1.0,
            acceleration: 1.0,
            jerk: None,
        }; 3];
        let sizes = [(); 3].map(|()| draw.size(-2.0, 2.0));
        let locators = [(); 3].map(|()| {
            let (anchor, origin) = (vector(draw, sizes[0]), vector(draw, sizes[1]));
            Locator::new(anchor.into(), origin.into(), limits)
        });
        let rotation = rotation(draw)?;
        Some(Self {
            platform: Platform::new(locators).ok()?,
            pose: Isometry3::from_parts(vector(draw, sizes[2]).into(), rotation),
            matrix: of_quaternion(&rotation),
        })
    }

    /// Where an anchor is.
    fn place(&self, anchor: &Point3<f64>) -> Vector {
        let [x, y, z] = times(&self.matrix, &anchor.coords);
        let translation = self.pose.translation.vector;
        [x + translation.x, y + translation.y, z + translation.z]
    }
}

/// Errors of positions and of axes, in parts of the lengths that are added.
pub(crate) fn positions_and_axes(draw: &mut Draw) -> Option<f64> {
    let body = Body::new(draw)?;
    let (positions, axes) = (
        body.platform.positions(&body.pose),
        body.platform.axes(&body.pose),
    );
    let mut worst = 0.0_f64;
    for (locator, (position, axes)) in body
        .platform
        .locators()
        .iter()
        .zip(positions.iter().zip(&axes))
    {
        let (place, origin) = (body.place(&locator.anchor), locator.origin.coords);
        let span = locator.anchor.coords.norm() + body.pose.translation.vector.norm();
        let off = |found: &Vector3<f64>, wanted: Vector| {
            epsilons(length::<3>(core::array::from_fn(|i| wanted[i] - found[i])))
        };
        worst = worst.max(off(&position.coords, place) / span);
        let wanted = core::array::from_fn(|i| place[i] - origin[i]);
        worst = worst.max(off(axes, wanted) / (span + origin.norm()));
    }
    Some(worst)
}

/// Changes of distances, in parts of anchor and translation.
pub(crate) fn distances_kept(draw: &mut Draw) -> Option<f64> {
    let body = Body::new(draw)?;
    let positions = body.platform.positions(&body.pose);
    let anchors = body.platform.anchors();
    let far = anchors.iter().map(|anchor| anchor.coords.norm());
    let far = far.fold(0.0, f64::max) + body.pose.translation.vector.norm();
    let apart = |points: &[Point3<f64>; 3], i: usize, j: usize| {
        length::<3>(core::array::from_fn(|k| exact(points[i][k]) - points[j][k]))
    };
    let pairs = [(0, 1), (1, 2), (2, 0)].into_iter();
    let changes = pairs.map(|(i, j)| epsilons(apart(&positions, i, j) - apart(anchors, i, j)));
    Some(changes.fold(0.0, f64::max) / far)
}

/// The angle by which the rotation of points moved exactly, and rounded then, is off, in parts of
/// the largest coordinate over the width of the points.
pub(crate) fn fit_rotation(draw: &mut Draw) -> Option<f64> {
    let (rotation, frame) = (rotation(draw)?, rotation(draw)?);
    let matrix = of_quaternion(&rotation);
    let size = draw.size(-1.0, 3.0);
    let (width, height) = (draw.size(-7.0, 0.0), draw.within(0.0, 1.0));
    let (center, translation) = (vector(draw, size), vector(draw, size));
    let from = [(); 4].map(|()| {
        let local = vector(draw, 1.0);
        let local = Vector3::new(local.x, local.y * width, local.z * width * height);
        Point3::from(center + frame * local)
    });
    let to = from.map(|point| {
        let [x, y, z] = times(&matrix, &point.coords);
        Point3::from(rounded([
            x + translation.x,
            y + translation.y,
            z + translation.z,
        ]))
    });
    let fit = rigid_fit(&from, &to).ok()?;
    let found = of_quaternion(&fit.motion.rotation);
    let squares = (0..9)
        .map(|n| (n / 3, n % 3))
        .map(|(i, j)| found[i][j] - matrix[i][j]);
    let angle = squares.fold(exact(0.0), |sum, x| sum + x * x).sqrt() / 2f64.sqrt();
    let far = from.iter().chain(&to).map(|point| point.coords.amax());
    let far = far.fold(0.0, f64::max);
    Some(epsilons(angle) * width_of(&from) / far)
}

/// The largest distance from the line through the mean and the point that is farthest from it.
fn width_of(points: &[Point3<f64>; 4]) -> f64 {
    let mean: Vector3<f64> = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / 4.0;
    let arms = points.map(|p| p.coords - mean);
    let along = arms
        .iter()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .unwrap()
        .normalize();
    let widths = arms.iter().map(|arm| (arm - along * along.dot(arm)).norm());
    widths.fold(0.0, f64::max)
}
