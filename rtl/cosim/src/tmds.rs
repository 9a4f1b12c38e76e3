//! TMDS: the code of DVI and HDMI, as DVI 1.0 (Digital Display Working Group, 1999) writes it down in figures 3-5 and 3-6, and a
//! receiver for a lane's bits.

/// The control words for (c1, c0) = 00, 01, 10, 11.
pub const CONTROL: [u16; 4] = [0b11_0101_0100, 0b00_1010_1011, 0b01_0101_0100, 0b10_1010_1011];

/// The encoder: `cnt` is the running disparity of the standard.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    cnt: i32,
}

impl Encoder {
    /// The word of a byte of the picture; bit 0 is sent first.
    pub fn data(&mut self, d: u8) -> u16 {
        let bit = |v: u16, i: u32| v >> i & 1;
        let d16 = u16::from(d);
        let mut q_m = bit(d16, 0);
        let xnor = d.count_ones() > 4 || (d.count_ones() == 4 && bit(d16, 0) == 0);
        for i in 1..8 {
            let next = bit(q_m, i - 1) ^ bit(d16, i) ^ u16::from(xnor);
            q_m |= next << i;
        }
        let ones = (q_m & 0xff).count_ones() as i32;
        let zeros = 8 - ones;
        if !xnor {
            q_m |= 0x100;
        }
        let q_m8 = i32::from(!xnor);
        let low = q_m & 0xff;
        if self.cnt == 0 || ones == zeros {
            self.cnt += if xnor { zeros - ones } else { ones - zeros };
            let (top, low) = if xnor { (1, low ^ 0xff) } else { (0, low) };
            return top << 9 | (q_m & 0x100) | low;
        }
        if (self.cnt > 0 && ones > zeros) || (self.cnt < 0 && zeros > ones) {
            self.cnt += 2 * q_m8 + zeros - ones;
            1 << 9 | (q_m & 0x100) | (low ^ 0xff)
        } else {
            self.cnt += -2 * (1 - q_m8) + ones - zeros;
            (q_m & 0x100) | low
        }
    }

    /// The word of two control bits, outside of the picture.
    pub fn control(&mut self, c: u8) -> u16 {
        self.cnt = 0;
        CONTROL[usize::from(c & 3)]
    }
}

/// What a word means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// A byte of the picture.
    Data(u8),
    /// Two control bits.
    Control(u8),
}

/// The decoder of figure 3-6.
pub fn decode(word: u16) -> Symbol {
    if let Some(c) = CONTROL.iter().position(|&w| w == word) {
        return Symbol::Control(c as u8);
    }
    let d = if word >> 9 & 1 == 1 { !word } else { word } as u8;
    let chain = d ^ d << 1;
    let xor = word >> 8 & 1 == 1;
    Symbol::Data(if xor { chain } else { chain ^ 0xfe })
}

/// A lane's receiver: finds where words begin, from control words, which no data ever looks like for long.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    bits: u64,
    /// Bits since the last word, once words have been found.
    phase: Option<u32>,
    /// Bits since a control word would have ended, for each of ten phases: how many in a row.
    run: [u32; 10],
    count: u32,
}

impl Lane {
    /// The next bit; a word when one is complete.
    pub fn bit(&mut self, bit: bool) -> Option<u16> {
        self.bits = self.bits >> 1 | u64::from(bit) << 9;
        self.count = (self.count + 1) % 10;
        let word = (self.bits & 0x3ff) as u16;
        match self.phase {
            None => {
                let run = &mut self.run[self.count as usize];
                *run = if CONTROL.contains(&word) { *run + 1 } else { 0 };
                // A blank is at least 12 control words long, data look like one now and then.
                if *run == 12 {
                    self.phase = Some(self.count);
                }
                None
            }
            Some(phase) => (self.count == phase).then_some(word),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_encoded_is_decoded_and_stays_in_balance() {
        let mut encoder = Encoder::default();
        let mut random = crate::Random::new(1);
        let mut balance = 0;
        for _ in 0..100_000 {
            let d = random.below(256) as u8;
            let word = encoder.data(d);
            assert_eq!(decode(word), Symbol::Data(d));
            balance += 2 * word.count_ones() as i32 - 10;
            assert_eq!(balance, encoder.cnt, "cnt is the balance of what was sent");
            assert!(balance.abs() <= 10);
            let transitions = (word ^ word >> 1) & 0xff;
            assert!(transitions.count_ones() <= 5, "{word:010b}");
        }
    }

    #[test]
    fn words_of_the_standard() {
        // From a fresh start: black is a word of one level but for its flags.
        let mut encoder = Encoder::default();
        assert_eq!(encoder.data(0x00), 0b01_0000_0000);
        assert_eq!(encoder.data(0x00), 0b11_1111_1111);
        assert_eq!(encoder.control(0), 0b11_0101_0100);
        assert_eq!(encoder.data(0x10), 0b01_1111_0000);
    }
}
