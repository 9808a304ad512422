//! Transmitter and receiver circuits on a wire that is sampled sixteen times a bit at 9600 bit/s.

/// Time of one step.
pub(crate) const STEP_NS: u64 = 6510;

/// How characters are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    None,
    Even,
    Odd,
}

/// Baud rate and frame of a circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Setting {
    /// Steps of a bit: 16 at 9600 bit/s.
    pub(crate) bit: u32,
    pub(crate) parity: Parity,
}

pub(crate) const USUAL: Setting = Setting {
    bit: 16,
    parity: Parity::Even,
};

impl Setting {
    fn bits(self) -> u32 {
        if self.parity == Parity::None { 10 } else { 11 }
    }

    /// Start, data, parity and stop bits, the first one lowest.
    fn frame(self, byte: u8) -> u16 {
        let data = u16::from(byte) << 1;
        let ones = byte.count_ones() % 2 == 1;
        match self.parity {
            Parity::None => data | 1 << 9,
            Parity::Even => data | u16::from(ones) << 9 | 1 << 10,
            Parity::Odd => data | u16::from(!ones) << 9 | 1 << 10,
        }
    }
}

/// Sends one character after the other.
#[derive(Debug)]
pub(crate) struct Transmitter {
    setting: Setting,
    frame: u16,
    step: u32,
}

impl Transmitter {
    pub(crate) fn new(setting: Setting) -> Self {
        Self {
            setting,
            frame: 0,
            step: u32::MAX,
        }
    }

    pub(crate) fn is_free(&self) -> bool {
        self.step >= self.setting.bits() * self.setting.bit
    }

    pub(crate) fn load(&mut self, byte: u8) {
        self.frame = self.setting.frame(byte);
        self.step = 0;
    }

    /// The level of this step: high in idle.
    pub(crate) fn step(&mut self) -> bool {
        if self.is_free() {
            return true;
        }
        let bit = self.step / self.setting.bit;
        self.step += 1;
        self.frame >> bit & 1 == 1
    }
}

/// Looks for characters in a level.
#[derive(Debug)]
pub(crate) struct Receiver {
    setting: Setting,
    step: Option<u32>,
    frame: u16,
    /// High since the last character with a wrong stop bit.
    is_ready: bool,
}

impl Receiver {
    pub(crate) fn new(setting: Setting) -> Self {
        Self {
            setting,
            step: None,
            frame: 0,
            is_ready: true,
        }
    }

    pub(crate) fn is_idle(&self) -> bool {
        self.step.is_none() && self.is_ready
    }

    /// Takes the level of a step; a character, if it ended: `None` for a wrong parity or stop bit.
    pub(crate) fn step(&mut self, level: bool) -> Option<Option<u8>> {
        self.is_ready |= level;
        if self.step.is_none() && !level && self.is_ready {
            (self.step, self.frame) = (Some(0), 0);
        }
        let step = self.step?;
        let bit = step / self.setting.bit;
        self.step = Some(step + 1);
        if step % self.setting.bit != self.setting.bit / 2 {
            return None;
        }
        self.frame |= u16::from(level) << bit;
        if bit == 0 && level {
            self.step = None; // a spike
        }
        if bit + 1 < self.setting.bits() {
            return None;
        }
        self.step = None;
        self.is_ready = level;
        let byte = u8::try_from(self.frame >> 1 & 0xFF).unwrap();
        Some((self.frame == self.setting.frame(byte)).then_some(byte))
    }
}
