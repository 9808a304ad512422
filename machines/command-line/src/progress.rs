//! A progress bar that appears when something takes longer than a second.

use core::cell::Cell;
use core::time::Duration;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);

/// Progress of a work; shown on standard error, if that is a terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
    hidden: Cell<bool>,
}

impl Progress {
    fn new(what: &'static str) -> Self {
        let bar =
            ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden()).with_message(what);
        if let Ok(style) =
            ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} % {eta:>4}")
        {
            bar.set_style(style);
        }
        Self {
            bar,
            begun: Instant::now(),
            hidden: Cell::new(true),
        }
    }

    /// Shows the progress of a work while it lasts: it says how much is done, of how much in all.
    pub fn during<T>(what: &'static str, work: impl FnOnce(&dyn Fn(u64, u64)) -> T) -> T {
        let progress = Self::new(what);
        work(&|done, total| progress.at(done, total))
    }

    fn at(&self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
        if self.hidden.get() && self.begun.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.hidden.set(false);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
