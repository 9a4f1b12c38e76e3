//! A device's register.

/// A register of 32 bits at an address of the machine's memory map. Whoever names an address answers for it.
#[derive(Clone, Copy)]
pub struct Register(pub usize);

impl Register {
    /// Reads it.
    pub fn read(self) -> u32 {
        // SAFETY: the boards name registers of their machine, see each one's `main`.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    /// Writes it.
    pub fn write(self, value: u32) {
        // SAFETY: as above.
        unsafe { (self.0 as *mut u32).write_volatile(value) }
    }

    /// Clears some bits, then sets some.
    pub fn change(self, clear: u32, set: u32) {
        self.write(self.read() & !clear | set);
    }
}
