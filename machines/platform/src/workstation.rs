//! The control's end of the line: station, driver and panel.

use core::time::Duration;

use handwheel::{
    Command, Driver, Event, Job, LcdAnswer, Led, LedState, MAX_COMMAND, Model, Timeouts,
};
use proto3964r::{Config, Station};
use serde::Serialize;

use crate::arbiter::{Arbiter, PendantId};
use crate::line::PACED;
use crate::panel::{Action, Input, Panel, PanelSettings, PanelSettingsError};
use crate::screen::Shown;

const MODEL: Model = Model::Hbls;

/// Telegrams, as the workstation counts them.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub(crate) struct Telegrams {
    status_requests: usize,
    leds: usize,
    display_blocks: usize,
    keys: usize,
    rotary_switches: usize,
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
            + self.leds
            + self.display_blocks
            + self.keys
            + self.rotary_switches
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
    /// The LED as it was last set.
    led: Option<LedState>,
    pub(crate) telegrams: Telegrams,
}

impl<const N: usize> Workstation<N> {
    pub(crate) fn new(settings: PanelSettings) -> Result<Self, PanelSettingsError> {
        Ok(Self {
            station: Station::new(Config::euchner_hbls(PACED)),
            driver: Driver::new(MODEL, Timeouts::DEFAULT),
            panel: Panel::new(PendantId(1), settings)?,
            arbiter: Arbiter::new(),
            shown: Shown::UNKNOWN,
            led: None,
            telegrams: Telegrams::default(),
        })
    }

    /// Hands something to the panel.
    pub(crate) fn input(&mut self, input: Input) -> Option<Action> {
        self.panel.handle(input, &mut self.arbiter)
    }

    /// Takes what station and driver have to say; returns what the machine must do.
    pub(crate) fn work(&mut self, now: Duration) -> Vec<Action> {
        self.station.handle_timeout(now);
        self.driver.handle_timeout(now);
        let mut actions = self.drain();
        while let Some(event) = self.station.poll_event() {
            match event {
                proto3964r::Event::Received(telegram) => self.driver.handle_block(now, telegram),
                proto3964r::Event::Sent { .. } => self.driver.handle_delivered(now),
                proto3964r::Event::Failed(_) => {
                    self.telegrams.failed += 1;
                    self.driver.handle_failed(now);
                }
                proto3964r::Event::Rejected(_) => self.telegrams.rejected += 1,
                _ => {}
            }
            actions.extend(self.drain());
        }
        actions
    }

    /// Hands the driver's events to the panel.
    fn drain(&mut self) -> Vec<Action> {
        let mut actions = Vec::new();
        while let Some(event) = self.driver.poll_event() {
            actions.extend(self.event(&event));
        }
        actions
    }

    fn event(&mut self, event: &Event) -> Option<Action> {
        let telegrams = &mut self.telegrams;
        match event {
            Event::Key(_) => telegrams.keys += 1,
            Event::RotarySwitch(..) => telegrams.rotary_switches += 1,
            Event::Status { connected, .. } => {
                telegrams.status_replies += 1;
                if *connected {
                    self.shown = Shown::UNKNOWN;
                    self.led = None;
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
                self.led = None;
            }
            Event::Unreadable(_) => telegrams.rejected += 1,
            _ => {}
        }
        self.input(Input::of_event(event)?)
    }

    /// Asks the driver for the next telegram, when the line is free. What the LED and the display
    /// lack goes first.
    pub(crate) fn talk(
        &mut self,
        now: Duration,
        positions_um: &[[i32; 3]; N],
    ) -> anyhow::Result<()> {
        if self.driver.is_online() && !self.driver.is_busy() {
            let state = self.panel.led();
            let screen = self.panel.screen(&self.arbiter, positions_um);
            if self.led != Some(state) {
                let led = Some(Led::MIN);
                self.driver.submit(Job::Led { led, state })?;
                self.led = Some(state);
            } else if let Some(block) = self.shown.update(&screen, MODEL) {
                self.driver.submit(Job::Lcd(block))?;
            }
        }
        if !self.station.is_idle() || self.station.is_busy() {
            return Ok(());
        }
        if let Some(telegram) = self.driver.poll_transmit(now) {
            let count = match Command::decode(MODEL, telegram)? {
                Command::StatusRequest => &mut self.telegrams.status_requests,
                Command::Lcd(_) => &mut self.telegrams.display_blocks,
                _ => &mut self.telegrams.leds,
            };
            *count += 1;
            self.station.submit(now, telegram)?;
        }
        Ok(())
    }
}
