//! A verilated module.

use std::ffi::c_void;

/// The C side of a configuration; the build script writes the table of them.
pub(crate) struct Verilated {
    name: &'static str,
    new: unsafe extern "C" fn() -> *mut c_void,
    delete: unsafe extern "C" fn(*mut c_void),
    eval: unsafe extern "C" fn(*mut c_void),
    port: unsafe extern "C" fn(*mut c_void, u32) -> *mut c_void,
    /// Name and width in bits.
    ports: &'static [(&'static str, u32)],
}

include!(concat!(env!("OUT_DIR"), "/verilated.rs"));

/// A port of a [`Model`]; of no use to another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port(usize);

/// One instance of a verilated configuration.
pub struct Model {
    shim: &'static Verilated,
    handle: *mut c_void,
    /// Where each port's value lies: u8, u16, u32, u64 or words of u32, by its width.
    fields: Vec<*mut c_void>,
    clk: Option<Port>,
    clocks: u64,
}

impl Model {
    /// The configuration NAME of `rtl/configurations.txt`, with random registers, all inputs 0; not reset yet.
    ///
    /// # Panics
    /// When there is no such configuration with the letter c.
    pub fn new(name: &str) -> Model {
        let Some(shim) = VERILATED.iter().find(|shim| shim.name == name) else {
            let names: Vec<&str> = VERILATED.iter().map(|shim| shim.name).collect();
            panic!("rtl/configurations.txt has no {name} with the letter c; it has {names:?}");
        };
        // SAFETY: the shim's functions take what `new` gave, and the number of a port in its own table.
        let (handle, fields) = unsafe {
            let handle = (shim.new)();
            (handle, (0..shim.ports.len()).map(|i| (shim.port)(handle, i as u32)).collect())
        };
        let mut model = Model { shim, handle, fields, clk: None, clocks: 0 };
        for index in 0..shim.ports.len() {
            for lsb in (0..shim.ports[index].1).step_by(32) {
                let width = 32.min(shim.ports[index].1 - lsb);
                model.set_bits(Port(index), lsb, width, 0);
            }
        }
        model.clk = model.find("clk");
        model
    }

    /// The port of this name, if there is one.
    pub fn find(&self, name: &str) -> Option<Port> {
        self.shim.ports.iter().position(|port| port.0 == name).map(Port)
    }

    /// The port of this name.
    ///
    /// # Panics
    /// When there is none.
    pub fn port(&self, name: &str) -> Port {
        self.find(name).unwrap_or_else(|| {
            let names: Vec<&str> = self.shim.ports.iter().map(|port| port.0).collect();
            panic!("{} has no port {name}; it has {names:?}", self.shim.name)
        })
    }

    /// Width of a port in bits.
    pub fn width(&self, port: Port) -> u32 {
        self.shim.ports[port.0].1
    }

    /// The value of a port of at most 64 bits, zero-extended.
    pub fn get(&self, port: Port) -> u64 {
        let field = self.fields[port.0];
        // SAFETY: the field lives as long as the model, and Verilator's type follows from the width.
        unsafe {
            match self.width(port) {
                0..=8 => u64::from(field.cast::<u8>().read()),
                9..=16 => u64::from(field.cast::<u16>().read()),
                17..=32 => u64::from(field.cast::<u32>().read()),
                33..=64 => field.cast::<u64>().read(),
                bits => panic!("{} is {bits} bits wide: use bits", self.shim.ports[port.0].0),
            }
        }
    }

    /// The value of a port of at most 64 bits, sign-extended.
    pub fn get_signed(&self, port: Port) -> i64 {
        let unused = 64 - self.width(port);
        ((self.get(port) << unused) as i64) >> unused
    }

    /// Sets an input of at most 64 bits; higher bits of the value are cut off, so that it may be signed.
    pub fn set(&mut self, port: Port, value: impl TryInto<i128>) {
        let value = value.try_into().unwrap_or_else(|_| unreachable!("every integer fits")) as u64;
        let bits = self.width(port);
        let value = if bits < 64 { value & ((1 << bits) - 1) } else { value };
        let field = self.fields[port.0];
        // SAFETY: as in `get`.
        unsafe {
            match bits {
                0..=8 => field.cast::<u8>().write(value as u8),
                9..=16 => field.cast::<u16>().write(value as u16),
                17..=32 => field.cast::<u32>().write(value as u32),
                33..=64 => field.cast::<u64>().write(value),
                _ => panic!("{} is {bits} bits wide: use set_bits", self.shim.ports[port.0].0),
            }
        }
    }

    /// `width` <= 64 bits of a port of any width, from bit `lsb` upwards.
    pub fn bits(&self, port: Port, lsb: u32, width: u32) -> u64 {
        assert!(width <= 64 && lsb + width <= self.width(port));
        if self.width(port) <= 64 {
            return (self.get(port) >> lsb) & (u64::MAX >> (64 - width));
        }
        let words = self.fields[port.0].cast::<u32>();
        (0..width).fold(0, |value, i| {
            let bit = lsb + i;
            // SAFETY: as in `get`; the word lies within the port.
            let word = unsafe { words.add(bit as usize / 32).read() };
            value | u64::from(word >> (bit % 32) & 1) << i
        })
    }

    /// Sets `width` <= 64 bits of an input of any width.
    pub fn set_bits(&mut self, port: Port, lsb: u32, width: u32, value: u64) {
        assert!(width <= 64 && lsb + width <= self.width(port));
        if self.width(port) <= 64 {
            let mask = (u64::MAX >> (64 - width)) << lsb;
            let value = (self.get(port) & !mask) | ((value << lsb) & mask);
            return self.set(port, value);
        }
        let words = self.fields[port.0].cast::<u32>();
        for i in 0..width {
            let bit = lsb + i;
            // SAFETY: as in `get`; the word lies within the port.
            unsafe {
                let word = words.add(bit as usize / 32);
                word.write(
                    (word.read() & !(1 << (bit % 32))) | ((value >> i & 1) as u32) << (bit % 32),
                );
            }
        }
    }

    /// Lets the inputs take effect on outputs without a register between.
    pub fn eval(&mut self) {
        // SAFETY: the handle is what `new` gave.
        unsafe { (self.shim.eval)(self.handle) }
    }

    /// One period of `clk`: the falling edge, then the rising one. Set the inputs before, read outputs after `eval`.
    pub fn clock(&mut self) {
        if let Some(clk) = self.clk {
            self.set(clk, 0);
            self.eval();
            self.set(clk, 1);
        }
        self.eval();
        self.clocks += 1;
    }

    /// Four clocks with `rst_n` low, then high.
    pub fn reset(&mut self) {
        let rst_n = self.port("rst_n");
        self.set(rst_n, 0);
        (0..4).for_each(|_| self.clock());
        self.set(rst_n, 1);
        self.eval();
    }

    /// Periods of `clk` so far.
    pub fn clocks(&self) -> u64 {
        self.clocks
    }
}

impl Drop for Model {
    fn drop(&mut self) {
        // SAFETY: the handle is what `new` gave, and nobody uses it any more.
        unsafe { (self.shim.delete)(self.handle) }
    }
}
