#!/usr/bin/env node
// Runs the firmware in an emulated RP2040 (npm rp2040js 1.4.1), from its vector table in flash through clocks and SPI0.
//
//   NODE_PATH=... node emulate.cjs FIRMWARE.elf FRAMES > display 2> messages
//
// Standard output: what SPI0 sends, with the level of D/C (GP16), in the records of firmware/player/src/wire.rs; a line "frame" on
// UART0 ends one. Standard error: UART0, and how deep the stack went.
'use strict';

const fs = require('fs');
const { RP2040, GPIOPinState } = require('rp2040js');

const FLASH = 0x10000000;
const VECTORS = 0x100; // behind the second stage of the boot
const DC = 16;
const CS = 17;
const MOST_INSTRUCTIONS = 2e9;

const [file, wanted] = process.argv.slice(2);
if (!file || !(Number(wanted) > 0)) {
    process.stderr.write('usage: node emulate.cjs FIRMWARE.elf FRAMES > display\n');
    process.exit(2);
}

const chip = new RP2040();
chip.logger = { debug() {}, info() {}, warn() {}, error(component, text) { fail(`${component}: ${text}`); } };

function fail(text) {
    process.stderr.write(`emulate.cjs: ${text}\n`);
    process.exit(1);
}

// The segments of the ELF that lie in flash, at their load addresses.
const elf = fs.readFileSync(file);
if (elf.toString('latin1', 0, 4) !== '\x7fELF') { fail(`${file} is no ELF`); }
const [table, size, count] = [elf.readUInt32LE(28), elf.readUInt16LE(42), elf.readUInt16LE(44)];
for (let i = 0; i < count; i++) {
    const at = table + i * size;
    const [type, offset, , physical, bytes] = [0, 4, 8, 12, 16].map((field) => elf.readUInt32LE(at + field));
    if (type === 1 && bytes > 0) { chip.flash.set(elf.subarray(offset, offset + bytes), physical - FLASH); }
}

// Records of equal D/C level.
let pending = [];
let level = false;
const out = [];
function record() {
    for (let at = 0; at < pending.length; at += 0x3fff) {
        const piece = pending.slice(at, at + 0x3fff);
        out.push(Buffer.from([(level ? 0x80 : 0) | piece.length >> 8, piece.length & 255]), Buffer.from(piece));
    }
    pending = [];
}

const spi = chip.spi[0];
spi.onTransmit = (byte) => {
    if (chip.gpio[CS].value !== GPIOPinState.Low) { fail('a byte on SPI0 while the display is not selected'); }
    const dc = chip.gpio[DC].value === GPIOPinState.High;
    if (dc !== level) {
        record();
        level = dc;
    }
    pending.push(byte);
    spi.completeTransmit(0);
};

let frames = 0;
let line = '';
chip.uart[0].onByte = (byte) => {
    if (byte !== 10) {
        line += String.fromCharCode(byte);
        return;
    }
    if (line === 'frame') {
        record();
        out.push(Buffer.from([0x40, 0]));
        frames++;
    } else {
        process.stderr.write(`${line}\n`);
    }
    line = '';
};

const core = chip.core;
core.VTOR = FLASH + VECTORS;
const top = chip.flashView.getUint32(VECTORS, true);
core.SP = top;
core.PC = chip.flashView.getUint32(VECTORS + 4, true) & ~1;
let lowest = top;
let instructions = 0;
const nanoseconds = 1e9 / 125e6;
while (frames < Number(wanted)) {
    if (instructions > MOST_INSTRUCTIONS) { fail(`${frames} frames after ${instructions} instructions`); }
    const cycles = core.executeInstruction();
    chip.clock.tick((cycles || 1) * nanoseconds);
    instructions++;
    if (core.SP < lowest) { lowest = core.SP; }
}
process.stderr.write(`${frames} frames, ${instructions} instructions, ${top - lowest} bytes of stack, clock ${chip.clkSys} Hz\n`);
fs.writeSync(1, Buffer.alloc(0));
for (const piece of out) {
    let at = 0;
    while (at < piece.length) {
        try {
            at += fs.writeSync(1, piece, at);
        } catch (error) {
            if (error.code !== 'EAGAIN') { throw error; }
        }
    }
}
