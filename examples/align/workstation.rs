//! The workstation's side of the unit: station, driver and panel.

use pose2pulse::handwheel::{
    Action, Arbiter, Command, Driver, Event, Input, Instant, LcdAnswer, Led, Light, MAX_COMMAND,
    Model, Panel, Settings, SettingsError, Shown, Timing, UnitId,
};
use proto3964r::{Config, Priority, Station};
use serde::Serialize;

use crate::line::{BITS_PER_CHARACTER, BITS_PER_SECOND};

const MODEL: Model = Model::Hbls;

/// Telegrams, as the workstation counts them.
#[derive(Clone, Copy, Default, Serialize)]
pub(crate) struct Telegrams {
    status_requests: usize,
    lamps: usize,
    display_blocks: usize,
    keys: usize,
    knobs: usize,
    status_replies: usize,
    display_answers: usize,
    /// Sent, and not acknowledged in all attempts.
    failed: usize,
    /// Received, and rejected or not understood.
    rejected: usize,
}

impl Telegrams {
    pub(crate) const fn total(&self) -> usize {
        self.status_requests
            + self.lamps
            + self.display_blocks
            + self.keys
            + self.knobs
            + self.status_replies
            + self.display_answers
    }
}

pub(crate) struct Workstation<const N: usize> {
    pub(crate) station: Station<MAX_COMMAND>,
    pub(crate) driver: Driver,
    pub(crate) panel: Panel,
    arbiter: Arbiter<N>,
    shown: Shown,
    /// The lamp as it was last set.
    light: Option<Light>,
    pub(crate) telegrams: Telegrams,
}

impl<const N: usize> Workstation<N> {
    pub(crate) fn new(settings: Settings) -> Result<Self, SettingsError> {
        let line = Config::euchner_hbls()
            .with_priority(Priority::High)
            .with_line(BITS_PER_SECOND, BITS_PER_CHARACTER);
        Ok(Self {
            station: Station::new(line),
            driver: Driver::new(MODEL, Timing::DEFAULT),
            panel: Panel::new(UnitId(1), settings)?,
            arbiter: Arbiter::new(),
            shown: Shown::UNKNOWN,
            light: None,
            telegrams: Telegrams::default(),
        })
    }

    /// Hands something to the panel.
    pub(crate) fn input(&mut self, input: Input) -> Option<Action> {
        self.panel.handle(input, &mut self.arbiter)
    }

    /// Takes what station and driver have to say; returns what the machine must do.
    pub(crate) fn work(&mut self, now_us: u64) -> Vec<Action> {
        let now = Instant::from_micros(now_us);
        self.station
            .handle_timeout(proto3964r::Instant::from_micros(now_us));
        let mut events: Vec<_> = self.driver.handle_timeout(now).into_iter().collect();
        while let Some(event) = self.station.poll_event() {
            events.extend(match event {
                proto3964r::Event::Received(telegram) => self.driver.handle_block(now, telegram),
                proto3964r::Event::Sent { .. } => self.driver.handle_delivered(now),
                proto3964r::Event::Failed(_) => {
                    self.telegrams.failed += 1;
                    self.driver.handle_failed(now)
                }
                proto3964r::Event::Rejected(_) => {
                    self.telegrams.rejected += 1;
                    None
                }
                _ => None,
            });
        }
        events
            .iter()
            .filter_map(|event| self.event(event))
            .collect()
    }

    fn event(&mut self, event: &Event) -> Option<Action> {
        let telegrams = &mut self.telegrams;
        match event {
            Event::Key(_) => telegrams.keys += 1,
            Event::Knob(..) => telegrams.knobs += 1,
            Event::Status { connected, .. } => {
                telegrams.status_replies += 1;
                if *connected {
                    self.shown = Shown::UNKNOWN;
                    self.light = None;
                }
            }
            Event::Lcd { answer, .. } => {
                telegrams.display_answers += 1;
                if *answer != LcdAnswer::Done {
                    self.shown = Shown::UNKNOWN;
                }
            }
            Event::Failed(..) => {
                self.shown = Shown::UNKNOWN;
                self.light = None;
            }
            Event::Unreadable(_) => telegrams.rejected += 1,
            _ => {}
        }
        self.input(Input::of_event(event)?)
    }

    /// Asks the driver for the next telegram, when the line is free. What the lamp and the display
    /// lack goes first.
    pub(crate) fn talk(&mut self, now_us: u64, positions_um: &[[i32; 3]; N]) -> anyhow::Result<()> {
        if self.driver.is_online() && self.driver.is_ready() {
            let light = self.panel.light();
            let screen = self.panel.screen(&self.arbiter, positions_um);
            if self.light != Some(light) {
                self.driver.set_led(Some(Led::MIN), light)?;
                self.light = Some(light);
            } else if let Some(block) = self.shown.update(&screen, MODEL) {
                self.driver.send_lcd(&block)?;
            }
        }
        if !self.station.is_idle() || !self.station.can_send() {
            return Ok(());
        }
        let mut telegram = [0; MAX_COMMAND];
        let now = Instant::from_micros(now_us);
        if let Some(telegram) = self.driver.poll_transmit(now, &mut telegram)? {
            let count = match Command::decode(MODEL, telegram)? {
                Command::StatusRequest => &mut self.telegrams.status_requests,
                Command::Lcd(_) => &mut self.telegrams.display_blocks,
                _ => &mut self.telegrams.lamps,
            };
            *count += 1;
            self.station
                .send(proto3964r::Instant::from_micros(now_us), telegram)?;
        }
        Ok(())
    }
}
