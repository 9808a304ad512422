//! A program as the telegrams of a board.

use kurbo::Point;
use pulse_interp::Turn;

use super::program::Program;
use crate::motion::{Motion, Shape};

impl Program {
    /// Each motion as a telegram of the boards' firmware, `line X Y [F]`, `cw X Y I J F` or
    /// `ccw X Y I J F`, in mm and mm/s.
    ///
    /// The first one begins where the program does.
    pub fn telegrams(&self) -> impl Iterator<Item = String> {
        self.lines.iter().map(|line| telegram(&line.motion))
    }

    /// Where the program begins, and where each motion ends, X and Y in mm.
    pub fn ends(&self) -> impl Iterator<Item = [f64; 2]> {
        let first = self.lines.first().map(|line| line.motion.from);
        let ends = self.lines.iter().map(|line| line.motion.to);
        first.into_iter().chain(ends).map(|at| [at.x, at.y])
    }
}

fn telegram(motion: &Motion) -> String {
    let Point { x, y } = motion.to;
    match motion.shape {
        Shape::Line if motion.is_rapid => format!("line {x:.4} {y:.4}"),
        Shape::Line => format!("line {x:.4} {y:.4} {:.4}", motion.feed_mm_s),
        Shape::Arc { centre, turn, .. } => {
            let name = match turn {
                Turn::Clockwise => "cw",
                Turn::CounterClockwise => "ccw",
            };
            let to_centre = centre - motion.from;
            let [i, j] = [to_centre.x, to_centre.y];
            format!("{name} {x:.4} {y:.4} {i:.4} {j:.4} {:.4}", motion.feed_mm_s)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Program;

    #[test]
    fn lines_and_arcs_have_their_commands() {
        let program = "G0 X20 Y10\nG1 X30 F600\nG2 X40 Y20 I10 J0\nG3 X40 Y20 I-5";
        let program = Program::parse(program).unwrap();
        let telegrams: Vec<_> = program.telegrams().collect();
        assert_eq!(
            telegrams,
            [
                "line 20.0000 10.0000",
                "line 30.0000 10.0000 10.0000",
                "cw 40.0000 20.0000 10.0000 0.0000 10.0000",
                "ccw 40.0000 20.0000 -5.0000 0.0000 10.0000",
            ]
        );
        let ends: Vec<_> = program.ends().collect();
        let expected = [
            [0.0, 0.0],
            [20.0, 10.0],
            [30.0, 10.0],
            [40.0, 20.0],
            [40.0, 20.0],
        ];
        assert_eq!(ends, expected);
        assert!(
            telegrams.iter().all(|it| it.len() <= 64),
            "a board takes 64 bytes"
        );
    }
}
