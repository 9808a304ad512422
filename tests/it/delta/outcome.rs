//! Runs of the example `delta`, and where the platform hangs by the lengths of its rods alone.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::tools::command::{lines, run};
use crate::tools::example::example;
use crate::tools::report::{number, report_in};

/// The arms as this test has them: azimuth, R - r, Lb, La, in degrees and mm.
pub(crate) type Arms = [[f64; 4]; 3];

pub(crate) const THESIS: Arms = [
    [30.0, 24.0, 120.0, 243.0],
    [150.0, 24.0, 120.0, 243.0],
    [270.0, 24.0, 120.0, 243.0],
];

/// A finished run.
pub(crate) struct Run {
    pub(crate) answers: Vec<String>,
    /// Standard error, and the exit status.
    pub(crate) errors: Vec<String>,
    pub(crate) status: Option<i32>,
    pub(crate) report: Value,
    pub(crate) steps: Vec<(f64, [i32; 3])>,
    pub(crate) picture: String,
}

impl Run {
    pub(crate) fn read(folder: &Path, answers: Vec<String>) -> Self {
        let text = |name| fs::read_to_string(folder.join(name)).unwrap();
        let csv = text("steps.csv");
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("t_s,s1,s2,s3"));
        let steps = lines
            .map(|line| {
                let mut fields = line.split(',');
                let time = fields.next().unwrap().parse().unwrap();
                let steps = [(); 3].map(|()| fields.next().unwrap().parse().unwrap());
                assert_eq!(fields.next(), None);
                (time, steps)
            })
            .collect();
        Self {
            answers,
            errors: Vec::new(),
            status: None,
            report: report_in(folder),
            steps,
            picture: text("delta.svg"),
        }
    }

    pub(crate) fn of(arguments: &[&str], input: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let mut command = example("delta");
        command.args(arguments).arg("--out").arg(folder.path());
        let output = run(&mut command, input.as_bytes());
        let mut answers = lines(&output.stdout);
        answers.retain(|line| line.starts_with("ok ") || line.starts_with("error: "));
        let run = Self {
            errors: lines(&output.stderr),
            status: output.status.code(),
            ..Self::read(folder.path(), answers)
        };
        run.assert_refusals_are_reported();
        run
    }

    /// Lines that were refused, and only these, are an error: in one line, and by the exit status.
    pub(crate) fn assert_refusals_are_reported(&self) {
        let refused = self
            .answers
            .iter()
            .filter(|line| line.starts_with("error: "));
        let refused: Vec<_> = refused.collect();
        let reported: Vec<_> = self
            .errors
            .iter()
            .filter(|line| line.starts_with("error: "))
            .collect();
        assert_eq!(self.report["refused"], refused.len());
        assert_eq!(
            self.report["refusals"].as_array().unwrap().len(),
            refused.len()
        );
        assert_eq!(self.status, Some(i32::from(!refused.is_empty())));
        let Some(first) = refused.first() else {
            assert_eq!(reported, [""; 0]);
            return;
        };
        let (reason, start) = first.split_once("; the next move starts at ").unwrap();
        let count = format!(
            "{} of {} lines refused, the first: ",
            refused.len(),
            self.answers.len()
        );
        assert_eq!(
            reported,
            [&reason.replacen("error: ", &format!("error: {count}"), 1)]
        );
        for (k, word) in start.split(' ').enumerate() {
            let stays = self.number(&format!("/refusals/0/stays_at_mm/{k}"));
            assert!(
                (stays - word.parse::<f64>().unwrap()).abs() < 0.0006,
                "{start}"
            );
        }
    }

    pub(crate) fn number(&self, pointer: &str) -> f64 {
        number(&self.report, pointer)
    }

    pub(crate) fn place(&self, arms: &Arms, steps: [i32; 3]) -> [f64; 3] {
        let angle = |k: usize| {
            self.number(&format!("/home_rad/{k}"))
                + f64::from(steps[k]) * self.number("/rad_per_step")
        };
        forward(arms, [angle(0), angle(1), angle(2)])
    }
}

/// Where the platform hangs: Newton's method on the three rods' lengths.
pub(crate) fn forward(arms: &Arms, thetas: [f64; 3]) -> [f64; 3] {
    let mut at = [0.0, 0.0, -250.0];
    for _ in 0..12 {
        // Rods, and by how much the square of each is off.
        let rows = [0, 1, 2].map(|k| {
            let [azimuth, offset, upper, lower] = arms[k];
            let (sin, cos) = azimuth.to_radians().sin_cos();
            let out = offset + upper * thetas[k].sin();
            let rod = [
                at[0] - out * cos,
                at[1] - out * sin,
                at[2] + upper * thetas[k].cos(),
            ];
            let square: f64 = rod.iter().map(|r| r * r).sum();
            (rod, (lower * lower - square) / 2.0)
        });
        let determinant = |m: [[f64; 3]; 3]| {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        };
        let rods = rows.map(|(rod, _)| rod);
        let whole = determinant(rods);
        for (axis, place) in at.iter_mut().enumerate() {
            let mut replaced = rods;
            for (row, (_, off)) in replaced.iter_mut().zip(rows) {
                row[axis] = off;
            }
            *place += determinant(replaced) / whole;
        }
    }
    at
}

pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Distance from the straight line between two places.
pub(crate) fn off_line(p: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let way = [0, 1, 2].map(|k| to[k] - from[k]);
    let square: f64 = way.iter().map(|w| w * w).sum();
    let along: f64 = (0..3).map(|k| (p[k] - from[k]) * way[k]).sum();
    let share = (along / square).clamp(0.0, 1.0);
    distance(p, [0, 1, 2].map(|k| from[k] + way[k] * share))
}
