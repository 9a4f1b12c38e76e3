//! Instructions executed.

#[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
mod machine {
    /// The low 32 bits of `minstret`.
    pub fn now() -> u32 {
        let count: usize;
        // SAFETY: reads a counter.
        unsafe { core::arch::asm!("csrr {}, minstret", out(reg) count) };
        count as u32
    }

    pub fn start() {}

    pub fn since(before: u32) -> u64 {
        now().wrapping_sub(before).into()
    }

    pub fn instructions(count: u64) -> u64 {
        count
    }
}

#[cfg(target_arch = "arm")]
mod machine {
    /// SysTick: control, reload value, current value (Armv7-M, B3.3).
    const CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
    const RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
    const CURRENT: *mut u32 = 0xe000_e018 as *mut u32;
    const MOST: u32 = 0xff_ffff;

    /// On, from the processor's clock, without interrupts.
    pub fn start() {
        // SAFETY: the timer is nobody else's.
        unsafe {
            RELOAD.write_volatile(MOST);
            CURRENT.write_volatile(0);
            CONTROL.write_volatile(5);
        }
    }

    /// Counts down.
    pub fn now() -> u32 {
        // SAFETY: reads a counter.
        unsafe { CURRENT.read_volatile() }
    }

    pub fn since(before: u32) -> u64 {
        (before.wrapping_sub(now()) & MOST).into()
    }

    /// 25 MHz against an instruction a nanosecond.
    pub fn instructions(count: u64) -> u64 {
        40 * count
    }
}

#[cfg(not(any(target_arch = "arm", target_arch = "riscv32", target_arch = "riscv64")))]
mod machine {
    pub fn start() {}

    pub fn now() -> u32 {
        0
    }

    pub fn since(_before: u32) -> u64 {
        0
    }

    pub fn instructions(_count: u64) -> u64 {
        0
    }
}

/// Starts the counter.
pub fn start() {
    machine::start();
}

/// Its value, whichever way it counts.
pub fn now() -> u32 {
    machine::now()
}

/// Steps since then, for less than 2^24 of them.
pub fn since(before: u32) -> u64 {
    machine::since(before)
}

/// Steps in instructions; 0 where nothing counts.
pub fn instructions(steps: u64) -> u32 {
    machine::instructions(steps).min(u32::MAX.into()) as u32
}
