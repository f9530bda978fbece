//! FNV-1a, 64 bit, over words, least significant byte first.

pub struct Hash(pub u64);

impl Hash {
    pub fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    pub fn word(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
        }
    }

    pub fn number(&mut self, number: f32) {
        self.word(number.to_bits());
    }

    pub fn numbers(&mut self, numbers: &[f32]) {
        for &number in numbers {
            self.number(number);
        }
    }

    pub fn text(&mut self, text: &str) {
        for byte in text.bytes() {
            self.word(u32::from(byte));
        }
    }

    /// A status as C has it: its number and its name.
    pub fn status(&mut self, code: i32) {
        self.word(code as u32);
        // SAFETY: a string constant of the library.
        let name = unsafe { core::ffi::CStr::from_ptr(goe::ffi::goe_status_text(code)) };
        for &byte in name.to_bytes() {
            self.word(u32::from(byte));
        }
    }

    pub fn flags(&mut self, flags: &[bool]) {
        self.word(flags.iter().rev().fold(0, |bits, &flag| 2 * bits + u32::from(flag)));
    }
}
