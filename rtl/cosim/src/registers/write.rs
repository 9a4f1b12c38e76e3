//! The three files that the description becomes.

use std::fmt::Write as _;

use super::{ADDRESS_BITS, Access, Field, MAGIC, REGISTERS, Register, WINDOWS};

/// REGISTER_FIELD, or REGISTER where both are the same.
fn port(register: &Register, field: &Field) -> String {
    if register.name == field.name {
        register.name.into()
    } else {
        format!("{}_{}", register.name, field.name)
    }
}

fn range(bits: u32) -> String {
    if bits == 1 { String::new() } else { format!("[{}:0] ", bits - 1) }
}

fn each() -> impl Iterator<Item = (&'static Register, &'static Field)> {
    REGISTERS.iter().flat_map(|r| r.fields.iter().map(move |f| (r, f)))
}

/// `rtl/control_registers.sv`.
pub fn register_file() -> String {
    let mut text = String::from(
        "// Control: the register file behind Wishbone. Written by rtl/cosim/examples/registers.rs from the description in\n\
         // rtl/cosim/src/registers.rs, which also gives rtl/registers.md: change that, not this.\n\
         //\n\
         // Wishbone B4, classic cycles, 32 bits, addresses in words. wb_ack or wb_err comes one clock after wb_stb; wb_err means that there\n\
         // is no register at this address, or that a window was read. wb_sel chooses bytes of registers; windows take whole words.\n\
         // A window's word is written with NAME_write, window_index and window_data, in the clock of wb_ack.\n\
         `default_nettype none\n\n\
         module control_registers (\n",
    );
    let mut ports = vec![
        "input  wire logic clk".to_string(),
        "input  wire logic rst_n".into(),
        "input  wire logic wb_cyc".into(),
        "input  wire logic wb_stb".into(),
        "input  wire logic wb_we".into(),
        format!("input  wire logic [{}:0] wb_adr", ADDRESS_BITS - 1),
        "input  wire logic [3:0] wb_sel".into(),
        "input  wire logic [31:0] wb_dat_w".into(),
        "output logic [31:0] wb_dat_r".into(),
        "output logic wb_ack".into(),
        "output logic wb_err".into(),
    ];
    for (r, f) in each().filter(|(r, _)| r.name != "magic") {
        let direction = match f.access {
            Access::ReadOnly | Access::Sticky => "input  wire logic",
            Access::ReadWrite | Access::Pulse => "output logic",
        };
        ports.push(format!("{direction} {}{}", range(f.bits), port(r, f)));
    }
    ports.push(format!("output logic [{}:0] window_index", ADDRESS_BITS - 2));
    ports.push("output logic [31:0] window_data".into());
    ports.extend(WINDOWS.iter().map(|w| format!("output logic {}_write", w.name)));
    let _ = writeln!(text, "    {}\n);", ports.join(",\n    "));

    text.push_str("    logic request;\n    logic write;\n    logic known;\n    logic [31:0] mask;\n    logic [31:0] read;\n");
    for (r, f) in each().filter(|(_, f)| f.access == Access::Sticky) {
        let _ = writeln!(text, "    logic {}{}_seen;", range(f.bits), port(r, f));
    }
    text.push_str(
        "\n    assign request = wb_cyc && wb_stb && !wb_ack && !wb_err;\n    \
         assign write   = request && wb_we;\n    \
         assign mask    = {{8{wb_sel[3]}}, {8{wb_sel[2]}}, {8{wb_sel[1]}}, {8{wb_sel[0]}}};\n\n    \
         always_comb begin\n        known = 1'b1;\n        read  = '0;\n        case (wb_adr)\n",
    );
    for r in REGISTERS {
        let _ = writeln!(text, "            {ADDRESS_BITS}'h{:04x}: begin", r.address);
        for f in r.fields.iter().filter(|f| f.access != Access::Pulse) {
            let value = match (r.name, f.access) {
                ("magic", _) => format!("32'h{MAGIC:08x}"),
                (_, Access::Sticky) => format!("{}_seen", port(r, f)),
                _ => port(r, f),
            };
            let bits =
                if f.bits == 32 { String::new() } else { format!("[{}+:{}]", f.lsb, f.bits) };
            let _ = writeln!(text, "                read{bits} = {value};");
        }
        text.push_str("            end\n");
    }
    text.push_str("            default: known = 1'b0;\n        endcase\n");
    for w in WINDOWS {
        let _ = writeln!(
            text,
            "        if (wb_adr[{}:{}] == {}'h{:x}) known = wb_we;",
            ADDRESS_BITS - 1,
            w.words.ilog2(),
            ADDRESS_BITS - w.words.ilog2(),
            w.address / w.words
        );
    }
    text.push_str(
        "    end\n\n    always_ff @(posedge clk) begin\n        wb_ack       <= request && known;\n        \
         wb_err       <= request && !known;\n        wb_dat_r     <= read;\n        \
         window_index <= wb_adr[ADDRESS:0];\n        window_data  <= wb_dat_w;\n"
            .replace("ADDRESS", &(ADDRESS_BITS - 2).to_string())
            .as_str(),
    );
    for w in WINDOWS {
        let (high, low) = (ADDRESS_BITS - 1, w.words.ilog2());
        let value = w.address / w.words;
        let _ = writeln!(
            text,
            "        {}_write <= write && wb_adr[{high}:{low}] == {}'h{value:x};",
            w.name,
            ADDRESS_BITS - low
        );
    }
    for (r, f) in each() {
        let (name, here) =
            (port(r, f), format!("write && wb_adr == {ADDRESS_BITS}'h{:04x}", r.address));
        let bits = format!("[{}+:{}]", f.lsb, f.bits);
        let _ = match f.access {
            Access::ReadOnly => Ok(()),
            Access::ReadWrite => writeln!(
                text,
                "        if ({here}) {name} <= ({name} & ~mask{bits}) | (wb_dat_w{bits} & mask{bits});"
            ),
            Access::Pulse => {
                writeln!(text, "        {name} <= {here} && wb_dat_w[{0}] && mask[{0}];", f.lsb)
            }
            Access::Sticky => writeln!(
                text,
                "        {name}_seen <= ({name}_seen & ~({{{}{{{here}}}}} & wb_dat_w{bits} & mask{bits})) | {name};",
                f.bits
            ),
        };
    }
    text.push_str(
        "        if (!rst_n) begin\n            wb_ack <= 1'b0;\n            wb_err <= 1'b0;\n",
    );
    for (r, f) in each() {
        let _ = match f.access {
            Access::ReadOnly => Ok(()),
            Access::ReadWrite | Access::Pulse => {
                writeln!(text, "            {} <= {}'h{:x};", port(r, f), f.bits, f.reset)
            }
            Access::Sticky => writeln!(text, "            {}_seen <= '0;", port(r, f)),
        };
    }
    for w in WINDOWS {
        let _ = writeln!(text, "            {}_write <= 1'b0;", w.name);
    }
    text.push_str("        end\n    end\nendmodule\n\n`default_nettype wire\n");
    text
}

/// `rtl/cosim/src/register_map.rs`: no dependencies, so that a driver may copy it.
pub fn constants() -> String {
    let mut text = String::from(
        "//! Addresses (in words) and fields of the control registers. Written by `cargo run --example registers` from\n\
         //! `registers.rs`: change that, not this. It needs nothing else, so a driver may include the file.\n",
    );
    for r in REGISTERS {
        let name = r.name.to_uppercase();
        let _ = writeln!(
            text,
            "\n/// Register `{}`: address in words.\npub const {name}: u32 = 0x{:04x};",
            r.name, r.address
        );
        for f in r.fields {
            let full = port(r, f).to_uppercase();
            if f.bits < 32 {
                let mask = ((1u64 << f.bits) - 1) << f.lsb;
                let _ =
                    writeln!(text, "/// {}.\npub const {full}_MASK: u32 = 0x{mask:08x};", f.text);
                let _ =
                    writeln!(text, "/// Lowest bit of it.\npub const {full}_LSB: u32 = {};", f.lsb);
            }
            if f.reset != 0 {
                let _ = writeln!(
                    text,
                    "/// Its value after reset.\npub const {full}_RESET: u32 = 0x{:x};",
                    f.reset
                );
            }
        }
    }
    for w in WINDOWS {
        let name = w.name.to_uppercase();
        let _ = writeln!(
            text,
            "\n/// Window `{}`: {}.\npub const {name}: u32 = 0x{:04x};",
            w.name, w.text, w.address
        );
        let _ = writeln!(text, "/// Its words.\npub const {name}_WORDS: u32 = {};", w.words);
    }
    text
}

/// `rtl/registers.md`.
pub fn document() -> String {
    let mut text = String::from(
        "# Control registers\n\n\
         Written by `cargo run --example registers` in `rtl/cosim` from `src/registers.rs`. Words of 32 bits; addresses count words (times four\n\
         for a bus that counts bytes). The bus is Wishbone B4, classic; `axi4_lite_to_wishbone.sv` bridges AXI4-Lite to it. An address without a\n\
         register answers with an error. Bits that are not listed read 0.\n\n\
         | address | register | bits | field | access | after reset | meaning |\n|---|---|---|---|---|---|---|\n",
    );
    for (r, f) in each() {
        let bits = if f.bits == 1 {
            f.lsb.to_string()
        } else {
            format!("{}:{}", f.lsb + f.bits - 1, f.lsb)
        };
        let access = match f.access {
            Access::ReadOnly => "read",
            Access::ReadWrite => "read, write",
            Access::Sticky => "read, write 1 to clear",
            Access::Pulse => "write 1",
        };
        let reset = if f.access == Access::ReadOnly && f.reset == 0 {
            "-".into()
        } else {
            format!("0x{:x}", f.reset)
        };
        let _ = writeln!(
            text,
            "| 0x{:04x} | `{}` | {bits} | `{}` | {access} | {reset} | {} |",
            r.address, r.name, f.name, f.text
        );
    }
    text.push_str("\nMemories that can only be written, in whole words:\n\n| address | window | words | contents |\n|---|---|---|---|\n");
    for w in WINDOWS {
        let last = w.address + w.words - 1;
        let _ = writeln!(
            text,
            "| 0x{:04x} - 0x{last:04x} | `{}` | {} | {} |",
            w.address, w.name, w.words, w.text
        );
    }
    text
}
