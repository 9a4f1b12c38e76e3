//! The control registers and their bridge; and that the generated files are those of the description.

use std::path::Path;

use scanout_cosim::register_map as map;
use scanout_cosim::registers::{self, Access, REGISTERS, WINDOWS};
use scanout_cosim::{Model, Random};

#[test]
fn the_generated_files_are_up_to_date() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, wanted) in [
        ("../control_registers.sv", registers::register_file()),
        ("../registers.md", registers::document()),
        ("src/register_map.rs", registers::constants()),
    ] {
        let found = std::fs::read_to_string(here.join(path)).unwrap_or_default();
        assert!(
            found == wanted,
            "{path} is not what the description gives: cargo run --example registers"
        );
    }
}

#[test]
fn the_description_holds_together() {
    let mut next = 0;
    for r in REGISTERS {
        assert!(r.address >= next, "{} overlaps or is out of order", r.name);
        next = r.address + 1;
        let mut bit = 0;
        for f in r.fields {
            assert!(f.lsb >= bit && f.lsb + f.bits <= 32, "{}.{}", r.name, f.name);
            assert!(u64::from(f.reset) < 1 << f.bits, "{}.{}", r.name, f.name);
            bit = f.lsb + f.bits;
        }
    }
    for w in WINDOWS {
        assert!(
            w.address >= next && w.words.is_power_of_two() && w.address % w.words == 0,
            "{}",
            w.name
        );
        next = w.address + w.words;
    }
    assert!(next <= 1 << registers::ADDRESS_BITS);
    assert_eq!(map::CONTROL_ARRANGEMENT_MASK, 0x70);
    assert_eq!((map::MAGIC_RESET, map::MATRIX), (registers::MAGIC, 0x100));
}

/// A register file that a bus of either kind talks to.
trait Bus {
    /// The word, or an error.
    fn read(&mut self, address: u32) -> Result<u32, ()>;
    /// Whether it went well.
    fn write(&mut self, address: u32, word: u32, bytes: u8) -> Result<(), ()>;
}

struct Wishbone(Model);

impl Wishbone {
    fn cycle(&mut self, address: u32, write: Option<(u32, u8)>) -> Result<u32, ()> {
        let model = &mut self.0;
        let set = |model: &mut Model, name: &str, value: u32| {
            let port = model.port(name);
            model.set(port, value);
        };
        set(model, "wb_cyc", 1);
        set(model, "wb_stb", 1);
        set(model, "wb_we", write.is_some().into());
        set(model, "wb_adr", address);
        set(model, "wb_dat_w", write.map_or(0xdead_beef, |w| w.0));
        set(model, "wb_sel", write.map_or(15, |w| w.1).into());
        let [ack, err, data] = ["wb_ack", "wb_err", "wb_dat_r"].map(|name| model.port(name));
        for _ in 0..4 {
            model.clock();
            if model.get(ack) + model.get(err) == 1 {
                let result = if model.get(ack) == 1 { Ok(model.get(data) as u32) } else { Err(()) };
                set(model, "wb_cyc", 0);
                set(model, "wb_stb", 0);
                return result;
            }
        }
        panic!("no answer at 0x{address:x}");
    }
}

impl Bus for Wishbone {
    fn read(&mut self, address: u32) -> Result<u32, ()> {
        let word = self.cycle(address, None);
        self.0.clock();
        word
    }
    fn write(&mut self, address: u32, word: u32, bytes: u8) -> Result<(), ()> {
        self.cycle(address, Some((word, bytes))).map(|_| ())
    }
}

#[test]
fn registers_keep_what_the_description_says() {
    let mut bus = Wishbone(Model::new("control_registers"));
    bus.0.reset();
    let inputs: Vec<(&str, u32, u32)> = REGISTERS
        .iter()
        .filter(|r| r.name != "magic")
        .flat_map(|r| r.fields.iter().map(move |f| (r, f)))
        .filter(|(_, f)| f.access == Access::ReadOnly)
        .map(|(r, f)| (r.name, f.lsb, f.bits))
        .collect();
    assert!(inputs.len() > 5);
    let mut random = Random::new(1);
    // What reading gives, by the description.
    let mut words: Vec<u32> = REGISTERS
        .iter()
        .map(|r| {
            r.fields
                .iter()
                .filter(|f| f.access != Access::Pulse)
                .fold(0, |w, f| w | f.reset << f.lsb)
        })
        .collect();
    for turn in 0..20_000 {
        let i = random.below(REGISTERS.len() as u64) as usize;
        let r = &REGISTERS[i];
        match random.below(3) {
            0 => assert_eq!(bus.read(r.address), Ok(words[i]), "turn {turn}, {}", r.name),
            1 => {
                let (word, bytes) = (random.u64() as u32, random.below(16) as u8);
                let mask =
                    (0..4).filter(|b| bytes >> b & 1 == 1).fold(0u32, |m, b| m | 0xff << (8 * b));
                assert_eq!(bus.write(r.address, word, bytes), Ok(()));
                for f in r.fields {
                    let field = (((1u64 << f.bits) - 1) as u32) << f.lsb & mask;
                    match f.access {
                        Access::ReadWrite => words[i] = words[i] & !field | word & field,
                        Access::Sticky => words[i] &= !(word & field),
                        Access::ReadOnly => {}
                        Access::Pulse => {
                            let port = bus.0.port(&format!("{}_{}", r.name, f.name));
                            assert_eq!(bus.0.get(port) == 1, word & field != 0);
                            bus.0.clock();
                            assert_eq!(bus.0.get(port), 0, "a pulse is one clock long");
                        }
                    }
                }
            }
            _ => {
                // Hardware changes its values, and events stick.
                for r in REGISTERS.iter().filter(|r| r.name != "magic") {
                    let at = REGISTERS.iter().position(|o| o.name == r.name).unwrap_or(0);
                    for f in r.fields {
                        let name = if r.name == f.name {
                            r.name.into()
                        } else {
                            format!("{}_{}", r.name, f.name)
                        };
                        let mask = (((1u64 << f.bits) - 1) as u32) << f.lsb;
                        match f.access {
                            Access::ReadOnly => {
                                let value = random.u64() as u32 & (mask >> f.lsb);
                                let port = bus.0.port(&name);
                                bus.0.set(port, value);
                                words[at] = words[at] & !mask | value << f.lsb;
                            }
                            Access::Sticky if random.percent(20) => {
                                let port = bus.0.port(&name);
                                bus.0.set(port, 1);
                                bus.0.clock();
                                bus.0.set(port, 0);
                                words[at] |= mask;
                            }
                            _ => {}
                        }
                    }
                }
                bus.0.clock();
            }
        }
    }
}

#[test]
fn windows_are_written_and_the_rest_is_an_error() {
    let mut bus = Wishbone(Model::new("control_registers"));
    bus.0.reset();
    let writes: Vec<_> = WINDOWS.iter().map(|w| bus.0.port(&format!("{}_write", w.name))).collect();
    let [index, data] = ["window_index", "window_data"].map(|name| bus.0.port(name));
    for address in 0..1 << registers::ADDRESS_BITS {
        let register = REGISTERS.iter().any(|r| r.address == address);
        let window =
            WINDOWS.iter().position(|w| (w.address..w.address + w.words).contains(&address));
        assert_eq!(bus.read(address).is_ok(), register, "reading 0x{address:x}");
        let word = address.wrapping_mul(0x9e37_79b9);
        assert_eq!(
            bus.write(address, word, 15).is_ok(),
            register || window.is_some(),
            "0x{address:x}"
        );
        for (i, &port) in writes.iter().enumerate() {
            assert_eq!(bus.0.get(port) == 1, window == Some(i), "0x{address:x}");
        }
        if let Some(i) = window {
            let w = &WINDOWS[i];
            assert_eq!(bus.0.get(index) as u32 % w.words, address - w.address);
            assert_eq!(bus.0.get(data) as u32, word);
        }
        bus.0.clock();
        assert!(writes.iter().all(|&port| bus.0.get(port) == 0), "a write is one clock long");
    }
}

#[test]
fn axi4_lite_reaches_a_wishbone_memory() {
    let mut model = Model::new("axi4_lite_to_wishbone");
    model.reset();
    let mut random = Random::new(2);
    // A Wishbone memory of 64 words that answers after a while; beyond it is an error.
    let mut memory = [0u32; 64];
    let mut wanted = [0u32; 64];
    let names = [
        "s_axi_awvalid",
        "s_axi_awready",
        "s_axi_awaddr",
        "s_axi_wvalid",
        "s_axi_wready",
        "s_axi_wdata",
        "s_axi_wstrb",
        "s_axi_bvalid",
        "s_axi_bready",
        "s_axi_bresp",
        "s_axi_arvalid",
        "s_axi_arready",
        "s_axi_araddr",
        "s_axi_rvalid",
        "s_axi_rready",
        "s_axi_rdata",
        "s_axi_rresp",
    ];
    let [awv, awr, awa, wv, wr, wd, ws, bv, br, bresp, arv, arr, ara, rv, rr, rd, rresp] =
        names.map(|name| model.port(name));
    let [cyc, stb, we, adr, sel, dat_w, dat_r, ack, err] = [
        "wb_cyc", "wb_stb", "wb_we", "wb_adr", "wb_sel", "wb_dat_w", "wb_dat_r", "wb_ack", "wb_err",
    ]
    .map(|name| model.port(name));
    let (mut reads, mut writes, mut errors) = (0, 0, 0);
    for _ in 0..5000 {
        let address = random.below(80) as u32;
        let is_write = random.percent(50);
        let (word, bytes) = (random.u64() as u32, random.below(16) as u32);
        // Address and data come in any order; the response is fetched late.
        let late = [random.below(4), random.below(4), random.below(4)];
        let mut sent = [!is_write, !is_write, is_write];
        model.set(awa, address * 4 + random.below(4) as u32);
        model.set(ara, address * 4);
        model.set(wd, word);
        model.set(ws, bytes);
        let mut result = None;
        for clock in 0..100u64 {
            model.set(awv, u8::from(!sent[0] && clock >= late[0]));
            model.set(wv, u8::from(!sent[1] && clock >= late[1]));
            model.set(arv, u8::from(!sent[2] && clock >= late[0]));
            model.set(br, u8::from(clock >= 6 + late[2]));
            model.set(rr, u8::from(clock >= 6 + late[2]));
            let request = model.get(cyc) == 1 && model.get(stb) == 1;
            let answer = request && random.percent(40);
            let (at, write) = (model.get(adr) as usize, model.get(we) == 1);
            model.set(ack, u8::from(answer && at < 64));
            model.set(err, u8::from(answer && at >= 64));
            model.set(dat_r, memory.get(at).copied().unwrap_or(0x55));
            if answer && write && at < 64 {
                for b in (0..4).filter(|b| model.get(sel) >> b & 1 == 1) {
                    let mask = 0xff << (8 * b);
                    memory[at] = memory[at] & !mask | model.get(dat_w) as u32 & mask;
                }
            }
            model.eval();
            let fired = |v, r| model.get(v) == 1 && model.get(r) == 1;
            sent =
                [sent[0] || fired(awv, awr), sent[1] || fired(wv, wr), sent[2] || fired(arv, arr)];
            if fired(bv, br) {
                result = Some((model.get(bresp), None));
            }
            if fired(rv, rr) {
                result = Some((model.get(rresp), Some(model.get(rd) as u32)));
            }
            model.clock();
            if result.is_some() {
                break;
            }
        }
        let (response, data) = result.expect("an answer within 100 clocks");
        assert_eq!(response, if address < 64 { 0 } else { 2 });
        errors += u32::from(response != 0);
        if is_write {
            assert_eq!(data, None);
            writes += 1;
            if let Some(cell) = wanted.get_mut(address as usize) {
                for b in (0..4).filter(|b| bytes >> b & 1 == 1) {
                    *cell = *cell & !(0xff << (8 * b)) | word & 0xff << (8 * b);
                }
            }
        } else {
            reads += 1;
            let Some(data) = data else { panic!("a read was answered as a write") };
            assert!(address >= 64 || data == wanted[address as usize]);
        }
        assert_eq!(memory, wanted);
    }
    assert!(reads > 2000 && writes > 2000 && errors > 500);
}
