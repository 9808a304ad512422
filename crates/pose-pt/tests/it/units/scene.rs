//! Everything that the crate computes of one platform and one move, in a unit of length.

use crate::support::table::{Cut, plan};
use path_timing::{FeedCeiling, Knot, Row};
use pose_pt::nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use pose_pt::{
    FitError, LimitError, Locator, LocatorAxis, Platform, PlatformError, PosePath, PoseVector,
    PtError, PtTable, Segmentation, calibrate, hermite_distance_error, rigid_fit,
};

use crate::support::moves::ALL;
use crate::support::platform::{ACCELERATION, SPEED, panel_with, skewed};

/// A result, and the power of the length in it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Number {
    pub(crate) name: &'static str,
    pub(crate) value: f64,
    pub(crate) power: i32,
}

/// A move, in mm.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) poses: [Isometry3<f64>; 2],
    pub(crate) kind: usize,
    pub(crate) segments: u32,
    pub(crate) jerk: Option<f64>,
    pub(crate) is_skewed: bool,
}

impl Scene {
    /// All results where a length of 1 mm is `unit`.
    pub(crate) fn numbers(&self, unit: f64) -> Vec<Number> {
        let mut limits = LocatorAxis {
            min: -1500.0,
            max: 1500.0,
            speed: SPEED,
            acceleration: ACCELERATION,
            jerk: None,
        };
        limits.jerk = self.jerk;
        let platform = if self.is_skewed {
            skewed()
        } else {
            panel_with(limits)
        };
        let platform = scaled_platform(&platform, unit);
        let poses = self.poses.map(|pose| scaled_pose(&pose, unit));
        let mut numbers = Numbers(Vec::new());
        numbers.body(&platform, &poses, unit);
        numbers.measured(unit);
        numbers.refused(&platform, unit);
        let path = PosePath::new(&poses, ALL[self.kind]).unwrap();
        numbers.tables(&platform, &path, self.segments, unit);
        numbers.0
    }
}

pub(crate) fn scaled_pose(pose: &Isometry3<f64>, unit: f64) -> Isometry3<f64> {
    Isometry3::from_parts((pose.translation.vector * unit).into(), pose.rotation)
}

pub(crate) fn scaled_platform(platform: &Platform<3>, unit: f64) -> Platform<3> {
    Platform::new(platform.locators().map(|locator| {
        let limits = locator.limits.map(|limits| {
            let [min, max] = [limits.min, limits.max].map(|end| end * unit);
            let (speed, acceleration) = (limits.speed * unit, limits.acceleration * unit);
            let mut scaled = LocatorAxis {
                min,
                max,
                speed,
                acceleration,
                jerk: None,
            };
            scaled.jerk = limits.jerk.map(|jerk| jerk * unit);
            scaled
        });
        Locator::new(locator.anchor * unit, locator.origin * unit, limits).with_axes(locator.axes)
    }))
    .unwrap()
}

struct Numbers(Vec<Number>);

impl Numbers {
    fn put(&mut self, name: &'static str, power: i32, values: impl IntoIterator<Item = f64>) {
        let values = values.into_iter();
        self.0
            .extend(values.map(|value| Number { name, value, power }));
    }

    fn vectors<const N: usize>(&mut self, name: &'static str, vectors: &[Vector3<f64>; N]) {
        self.put(name, 1, vectors.iter().flat_map(|v| [v.x, v.y, v.z]));
    }

    fn points(&mut self, name: &'static str, points: &[Point3<f64>; 3]) {
        self.vectors(name, &points.map(|point| point.coords));
    }

    /// Poses, axes, fits.
    fn body(&mut self, platform: &Platform<3>, poses: &[Isometry3<f64>; 2], unit: f64) {
        let pose = &poses[1];
        let (linear, angular) = (Vector3::new(3.0, -2.0, 1.0), Vector3::new(0.1, 0.2, -0.3));
        self.put("distance", 1, [platform.largest_anchor_distance()]);
        self.points("positions", &platform.positions(pose));
        self.vectors("axes", &platform.checked_axes(pose).unwrap());
        let velocities = platform.axis_velocities(pose, &(linear * unit), &angular);
        self.vectors("velocities", &velocities);
        let accelerations = platform.axis_accelerations(pose, &(linear * unit), &angular, &angular);
        self.vectors("accelerations", &accelerations);

        // Strained by 0.3 mm and some.
        let mut axes = platform.axes(pose);
        axes[1].x += 0.3 * unit;
        axes[2] += Vector3::new(0.02, -0.1, 0.05) * unit;
        let points = platform.locator_positions(&axes);
        self.points("locators", &points);
        let body = platform.pose(&axes).unwrap();
        self.put("place", 1, body.pose.translation.vector.iter().copied());
        self.put("turn", 0, body.pose.rotation.coords.iter().copied());
        self.vectors("residuals", &body.residuals);
        let distance_error = body.distance_error;
        self.put(
            "distance error",
            1,
            [body.rms, distance_error.distance, distance_error.change],
        );
        let fit = rigid_fit(platform.anchors(), &points).unwrap();
        self.put("residual", 1, [fit.rms, fit.max_residual]);
        self.put("gap", 2, [fit.eigenvalue_gap]);
        let vector = PoseVector::from_isometry(pose, pose_pt::Convention::IntrinsicXyz).vector;
        self.put("vector", 1, vector.position().iter().copied());
        self.put("angles", 0, vector.angles().iter().copied());
    }

    /// A locator's frame from measured points, one of them wrong.
    fn measured(&mut self, unit: f64) {
        let axes = Matrix3::new(1.0001, 0.002, 0.0, -0.001, 0.9998, 0.003, 0.0005, 0.0, 1.0);
        let positions = [
            [0.0, 0.0, 0.0],
            [250.0, 0.0, 0.0],
            [0.0, 250.0, 0.0],
            [0.0, 0.0, 250.0],
            [-100.0, 200.0, 30.0],
        ]
        .map(|position| Vector3::from(position) * unit);
        let mut points = positions.map(|p| Point3::new(1200.0, -300.0, 800.0) * unit + axes * p);
        points[4].y += 0.1 * unit;
        let frame = calibrate(&positions, &points).unwrap();
        self.put("origin", 1, frame.origin.coords.iter().copied());
        self.put("residuals", 1, [frame.rms, frame.max_residual]);
        self.put("frame", 0, frame.axes.iter().copied());
        self.put("scales", 0, frame.scales().iter().copied());
        self.put("squareness", 0, frame.squareness_errors().iter().copied());
    }

    /// What errors state.
    fn refused(&mut self, platform: &Platform<3>, unit: f64) {
        let far = Isometry3::translation(0.0, 0.0, 2000.0 * unit);
        match platform.checked_axes(&far) {
            Err(LimitError::Stroke {
                value,
                min,
                max,
                by,
                ..
            }) => self.put("stroke", 1, [value, min, max, by]),
            other => panic!("{other:?}"),
        }
        let line = [0.0, 1.0, 3.0].map(|x| Point3::new(x * 1000.0, x * 200.0, 7.0) * unit);
        match rigid_fit(platform.anchors(), &line) {
            Err(FitError::Collinear {
                width,
                length,
                needed,
                ..
            }) => self.put("line", 1, [width, length, needed]),
            other => panic!("{other:?}"),
        }
        let mut locators = *platform.locators();
        locators[2].anchor = locators[1].anchor;
        match Platform::new(locators) {
            Err(PlatformError::Coincident {
                distance, needed, ..
            }) => self.put("coincident", 1, [distance, needed]),
            other => panic!("{other:?}"),
        }
        let poses = [
            Isometry3::identity(),
            Isometry3::translation(unit, 0.0, 0.0),
        ];
        let path = PosePath::new(&poses, ALL[0]).unwrap();
        match PtTable::plan(
            platform,
            &path,
            Segmentation::max_distance_error(1e-15 * unit),
        ) {
            Err(PtError::DistanceError { allowed, min }) => {
                self.put("min", 1, [allowed, min]);
            }
            other => panic!("{other:?}"),
        }
    }

    /// Paths, tables, runs.
    fn tables(&mut self, platform: &Platform<3>, path: &PosePath<'_>, segments: u32, unit: f64) {
        let leg = path.leg(0).unwrap();
        self.put("way", 1, [leg.length()]);
        self.put("leg's turn", 0, [leg.turn()]);
        self.put(
            "half way",
            1,
            leg.pose(0.5).translation.vector.iter().copied(),
        );
        let mut knots = vec![Knot::default(); 2000];
        for segmentation in [
            Segmentation::segments(segments.max(7)),
            Segmentation::steps(3.3 * unit, 0.013),
            Segmentation::max_distance_error(0.003_7 * unit),
        ] {
            let table = PtTable::plan(platform, path, segmentation).unwrap();
            self.put("PT distance error", 1, [table.distance_error_bound()]);
            self.put("PT time", 0, [table.duration_s()]);
            for point in table.points() {
                self.vectors("PT axes", &point.axes);
                self.put("PT segment", 0, [point.segment_s]);
            }
        }
        for cut in [Cut::Into(segments.max(7)), Cut::Within(0.003_7 * unit)] {
            let table = plan(platform, path, cut, &mut knots).unwrap();
            self.put("PVT time", 0, [table.duration_s()]);
            self.rows(platform, table.rows());
            let mut ceilings = vec![FeedCeiling::default(); table.len()];
            let slower = table.at_speed(0.7).unwrap();
            let mut playback = slower.playback(1.3, &mut ceilings).unwrap();
            playback.set_feed(1.2).unwrap();
            self.rows(platform, playback);
        }
    }

    fn rows(&mut self, platform: &Platform<3>, rows: impl Iterator<Item = Row<[[f64; 3]; 3]>>) {
        let rows: Vec<_> = rows.collect();
        for rows in rows.array_windows() {
            let [_, to] = rows;
            self.vectors("PVT axes", &to.position.map(Vector3::from));
            self.vectors("PVT speeds", &to.velocity.map(Vector3::from));
            self.put("PVT segment", 0, [to.duration_s]);
            self.put(
                "distance error",
                1,
                [hermite_distance_error(platform, rows)],
            );
        }
    }
}
