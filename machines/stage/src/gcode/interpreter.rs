//! Line by line from G-code to programmed motions.

use anyhow::{Context, Result, bail, ensure};
use kurbo::Point;
use pulse_interp::Turn;

use super::arc::{ARC_TOLERANCE_MM, Arc, Centre, SAME_MM};
use super::block::Block;
use super::codes::{self, Code, Mode, Plane};
use super::words;
use crate::motion::{Motion, RAPID_MM_S, Shape};
use machine_sim::input::Notes;

/// What the motors can follow; the note on feeds above says it too.
const FEEDS_MM_MIN: core::ops::RangeInclusive<f64> = 0.1..=6000.0;

/// A tenth of a step: what inches may be rounded by.
const UNSEEN_MM: f64 = 0.001;

/// What a line asks for.
pub(crate) enum Command {
    /// None, one, or over an intermediate point two.
    Moves(Vec<Motion>),
    /// The tape's mark, before and after a program.
    Mark,
    End,
}

/// The modal state of a program.
#[derive(Debug, Clone)]
pub(crate) struct Interpreter {
    at: Point,
    /// Of an axis that the stage has not, for arcs that stand upright; unknown at first.
    z_mm: Option<f64>,
    mode: Option<Mode>,
    plane: Plane,
    relative: bool,
    absolute_centres: bool,
    mm_per_unit: f64,
    feed_mm_min: Option<f64>,
    /// The first that was selected; all others are elsewhere.
    work_offset: Option<String>,
}

impl Default for Interpreter {
    fn default() -> Self {
        Self {
            at: Point::ORIGIN,
            z_mm: None,
            mode: None,
            plane: Plane::Xy,
            relative: false,
            absolute_centres: false,
            mm_per_unit: 1.0,
            feed_mm_min: None,
            work_offset: None,
        }
    }
}

impl Interpreter {
    pub(crate) const fn at(&self) -> Point {
        self.at
    }

    /// What one line asks for; on an error, the state is as before.
    pub(crate) fn line(&mut self, number: usize, line: &str, notes: &mut Notes) -> Result<Command> {
        let read = words::read(line)?;
        let (mut next, mut met) = (self.clone(), Notes::default());
        if read.can_be_deleted {
            met.add(number, "/", codes::DELETABLE);
        }
        let command = if read.is_mark {
            Command::Mark
        } else {
            let block = Block::new(number, &read.words, &mut met)?;
            next.command(&block, &mut met)?
        };
        *self = next;
        notes.merge(met);
        Ok(command)
    }

    /// A straight move from here, outside any program.
    pub(crate) fn jog(&self, to: Point) -> Motion {
        self.rapid_to(to)
    }

    /// The stage stands elsewhere than where the last line would have brought it.
    pub(crate) const fn stands_at(&mut self, at: Point) {
        self.at = at;
    }

    const fn rapid_to(&self, to: Point) -> Motion {
        Motion::rapid(self.at, to)
    }

    fn command(&mut self, block: &Block<'_>, notes: &mut Notes) -> Result<Command> {
        for (name, code) in &block.codes {
            self.set(name, *code, block, notes)?;
        }
        self.set_feed(block, notes)?;
        if block.has_code(Code::End) {
            ensure!(!block.has_axes(), "a motion with the end of the program");
            return Ok(Command::End);
        }
        let moves = if block.has_code(Code::Reference) {
            self.return_to_reference(block)
        } else if block.has_code(Code::Position) {
            self.check_position(block)?;
            Vec::new()
        } else {
            self.motion(block, notes)?.into_iter().collect()
        };
        // What has no length needs no steps.
        let goes = |it: &Motion| !matches!(it.shape, Shape::Line) || it.from != it.to;
        Ok(Command::Moves(moves.into_iter().filter(goes).collect()))
    }

    /// What holds from here on.
    fn set(&mut self, name: &str, code: Code, block: &Block<'_>, notes: &mut Notes) -> Result<()> {
        match code {
            Code::Motion(mode) => self.mode = Some(mode),
            // Beside a motion it says nothing more.
            Code::CyclesEnd if block.has_motion() => {}
            Code::CyclesEnd => self.mode = None,
            Code::Plane(plane) => self.plane = plane,
            Code::Unit(mm) => self.mm_per_unit = mm,
            Code::Relative(relative) => self.relative = relative,
            Code::AbsoluteCentres(absolute) => self.absolute_centres = absolute,
            Code::WorkOffset => self.select_offset(name, block, notes)?,
            Code::Reference if block.is_upright() => notes.add(block.line, name, codes::AXES),
            Code::Reference => notes.add(block.line, name, codes::HOMED),
            Code::MachineCoordinates => notes.add(block.line, name, codes::MACHINE),
            Code::Position => notes.add(block.line, name, codes::POSITION),
            // Wherever its Z ends, it is not known.
            Code::SecondReference => self.z_mm = None,
            Code::PassedOver(passed) if name.starts_with('G') && passed.own.contains('Z') => {
                self.z_mm = None;
            }
            // The refused ones have not come so far.
            Code::Dwell
            | Code::FeedPerMinute
            | Code::End
            | Code::PassedOver(_)
            | Code::Refused(_) => {}
        }
        Ok(())
    }

    fn select_offset(&mut self, name: &str, block: &Block<'_>, notes: &mut Notes) -> Result<()> {
        let selected = self.work_offset.get_or_insert_with(|| name.to_owned());
        ensure!(
            *selected == name,
            "{name}: a second work offset besides {selected}; the stage has one"
        );
        notes.add(block.line, name, codes::WORK_OFFSET);
        Ok(())
    }

    fn set_feed(&mut self, block: &Block<'_>, notes: &mut Notes) -> Result<()> {
        let Some(feed) = block.value('F') else {
            return Ok(());
        };
        let mm_min = feed * self.mm_per_unit;
        ensure!(
            mm_min >= *FEEDS_MM_MIN.start(),
            "F{feed}: {mm_min} mm/min, not within {FEEDS_MM_MIN:?}"
        );
        if mm_min > *FEEDS_MM_MIN.end() {
            notes.add(block.line, format!("F{feed}"), codes::HIGH_FEED);
        }
        self.feed_mm_min = Some(mm_min.min(*FEEDS_MM_MIN.end()));
        Ok(())
    }

    /// The feed of the motors along X and Y.
    fn feed_mm_s(&self) -> Result<f64> {
        let feed = self.feed_mm_min;
        let feed = feed.context("no F before the first G1, G2 or G3: undefined feed rate (22)")?;
        Ok(feed / 60.0)
    }

    /// A coordinate after this block, in mm.
    fn along(&self, block: &Block<'_>, letter: char, from: f64) -> f64 {
        let is_absolute = !self.relative || block.has_code(Code::MachineCoordinates);
        match block.value(letter).map(|value| value * self.mm_per_unit) {
            Some(to) if is_absolute => to,
            Some(by) => from + by,
            None => from,
        }
    }

    fn target(&self, block: &Block<'_>) -> Point {
        Point::new(
            self.along(block, 'X', self.at.x),
            self.along(block, 'Y', self.at.y),
        )
    }

    /// Over the point that the block names, in the axes that it names, or in all.
    fn return_to_reference(&mut self, block: &Block<'_>) -> Vec<Motion> {
        let over = self.rapid_to(self.target(block));
        self.at = over.to;
        let all = block.names_no_axis();
        let zero = |letter: &str, at: f64| if all || block.has(letter) { 0.0 } else { at };
        let to = Point::new(zero("X", self.at.x), zero("Y", self.at.y));
        let home = self.rapid_to(to);
        self.at = to;
        if all || block.has("Z") {
            self.z_mm = None;
        }
        vec![over, home]
    }

    /// G92 and G52, which may only say what holds anyhow.
    fn check_position(&mut self, block: &Block<'_>) -> Result<()> {
        let is_local = block.is_local();
        let all = block.names_no_axis();
        for (letter, at) in [('X', self.at.x), ('Y', self.at.y)] {
            let value = block.value(letter).or(all.then_some(0.0));
            let stays = if is_local { 0.0 } else { at };
            let moved = value.map(|value| value * self.mm_per_unit - stays);
            ensure!(
                moved.is_none_or(|mm| mm.abs() < UNSEEN_MM),
                "{letter} is {at:.3} mm here: its zero would move"
            );
        }
        match block.value('Z') {
            Some(_) if is_local => self.z_mm = None,
            Some(z) => self.z_mm = Some(z * self.mm_per_unit),
            None => {}
        }
        Ok(())
    }

    fn motion(&mut self, block: &Block<'_>, notes: &mut Notes) -> Result<Option<Motion>> {
        block.check_letters(self.mode)?;
        if !block.has_axes() {
            ensure!(!block.has_arc(), "an arc without I, J or R");
            return Ok(None);
        }
        let mode = self.mode.context("no G0, G1, G2 or G3 before")?;
        block.note_axes(notes);
        let (to, z_before) = (self.target(block), self.z_mm);
        self.z_mm = self.height(block);
        let shape = match mode {
            Mode::Rapid | Mode::Straight => Shape::Line,
            Mode::Cycle(number) => {
                notes.add(block.line, format!("G{number}"), codes::CYCLE);
                Shape::Line
            }
            Mode::Circular(turn) if self.plane == Plane::Xy => {
                let arc = Arc::new(self.at, to, turn, self.centre(block, ['I', 'J'])?)?;
                Shape::Arc {
                    centre: arc.centre,
                    turn,
                    sweep_rad: arc.sweep_rad,
                }
            }
            Mode::Circular(turn) => {
                self.check_upright(block, to, turn, z_before)?;
                let name = if self.plane == Plane::Zx {
                    "G18"
                } else {
                    "G19"
                };
                notes.add(block.line, name, codes::VERTICAL_ARC);
                Shape::Line
            }
        };
        let is_rapid = matches!(mode, Mode::Rapid | Mode::Cycle(_));
        let feed_mm_s = if is_rapid {
            RAPID_MM_S
        } else {
            self.feed_mm_s()?
        };
        let from = core::mem::replace(&mut self.at, to);
        Ok(Some(Motion {
            from,
            to,
            shape,
            feed_mm_s,
            is_rapid,
        }))
    }

    /// Z after this block, as far as it is known.
    fn height(&self, block: &Block<'_>) -> Option<f64> {
        if block.value('Z').is_none() {
            return self.z_mm;
        }
        if block.has_code(Code::MachineCoordinates) {
            return None;
        }
        match self.z_mm {
            Some(z) => Some(self.along(block, 'Z', z)),
            None if self.relative => None,
            None => Some(self.along(block, 'Z', 0.0)),
        }
    }

    /// Refuses an arc in a plane with Z that is no line from here to there, seen from above.
    fn check_upright(
        &self,
        block: &Block<'_>,
        to: Point,
        turn: Turn,
        z_before: Option<f64>,
    ) -> Result<()> {
        let z = z_before.zip(self.z_mm);
        let (z0, z1) = z.context("an arc in a plane with Z, and no Z before")?;
        let (ends, letters, seen, aside) = match self.plane {
            Plane::Zx => (
                [(z0, self.at.x), (z1, to.x)],
                ['K', 'I'],
                1,
                to.y - self.at.y,
            ),
            _ => (
                [(self.at.y, z0), (to.y, z1)],
                ['J', 'K'],
                0,
                to.x - self.at.x,
            ),
        };
        ensure!(
            aside.abs() < SAME_MM,
            "a helix about X or Y is no line seen from above"
        );
        let [from, to] = ends.map(Point::from);
        let arc = Arc::new(from, to, turn, self.centre(block, letters)?)?;
        let beyond = arc.overshoot_mm(seen);
        ensure!(
            beyond <= ARC_TOLERANCE_MM,
            "seen from above, the arc goes {beyond:.3} mm beyond its ends"
        );
        Ok(())
    }

    fn centre(&self, block: &Block<'_>, letters: [char; 2]) -> Result<Centre> {
        let mm = |letter| block.value(letter).map(|value| value * self.mm_per_unit);
        let offsets = letters.map(mm);
        Ok(match (mm('R'), offsets) {
            (Some(radius), [None, None]) => Centre::Radius(radius),
            (Some(_), _) => bail!("an arc with both R and {} or {}", letters[0], letters[1]),
            (None, [Some(x), Some(y)]) if self.absolute_centres => Centre::At(Point::new(x, y)),
            (None, _) if self.absolute_centres => {
                bail!(
                    "an arc after G90.1 without {} and {}",
                    letters[0],
                    letters[1]
                )
            }
            (None, offsets) => Centre::FromStart(offsets),
        })
    }
}
