#!/usr/bin/env node
// Runs the firmware in an emulated RP2040 (npm rp2040js 1.4.1), from its vector table in flash through clocks and SPI0.
//
//   NODE_PATH=... node emulate.cjs FIRMWARE.elf FRAMES > display 2> messages
//
// Standard output: what SPI0 sends, with the level of D/C (GP16), in the records of firmware/player/src/wire.rs; a line "frame" on
// UART0 ends one. Standard error: UART0, clocks of each frame, and how deep the stack went.
//
// A byte takes eight of the SPI's clocks, as on the wire, and the display reads D/C and CS with its last bit. Clocks are the Cortex-M0+'s
// own for each instruction; what the flash's cache misses cost is not modelled.
'use strict';

const fs = require('fs');
const { RP2040, GPIOPinState } = require('rp2040js');

const FLASH = 0x10000000;
const VECTORS = 0x100; // behind the second stage of the boot
const DC = 16;
const CS = 17;
const FREE = 21; // high while the DMA sends and the processor doesn't wait for it
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

// The segments of the ELF that lie in flash, at their load addresses; and where those in memory end.
const elf = fs.readFileSync(file);
if (elf.toString('latin1', 0, 4) !== '\x7fELF') { fail(`${file} is no ELF`); }
const [table, size, count] = [elf.readUInt32LE(28), elf.readUInt16LE(42), elf.readUInt16LE(44)];
const MEMORY = 0x20000000;
let statics = MEMORY;
for (let i = 0; i < count; i++) {
    const at = table + i * size;
    const [type, offset, address, physical, bytes, all] = [0, 4, 8, 12, 16, 20].map((field) => elf.readUInt32LE(at + field));
    if (type === 1 && address >= MEMORY) { statics = Math.max(statics, address + all); }
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

const high = (pin) => chip.gpio[pin].value === GPIOPinState.High;
const spi = chip.spi[0];
const frame = { began: 0, sent: 0, beneath: 0 };
let byte = 0;
let dc = false;
const sent = chip.clock.createAlarm(() => {
    if (high(CS)) { fail('the display is deselected before a byte on SPI0 has ended'); }
    if (high(DC) !== dc) { fail('D/C changes within a byte on SPI0'); }
    if (dc !== level) {
        record();
        level = dc;
    }
    pending.push(byte);
    frame.sent++;
    if (high(FREE)) { frame.beneath++; }
    spi.completeTransmit(0);
});
spi.onTransmit = (value) => {
    if (high(CS)) { fail('a byte on SPI0 while the display is not selected'); }
    [byte, dc] = [value, high(DC)];
    sent.schedule(8e9 / spi.clockFrequency);
};

let clocks = 0;
let frames = 0;
let line = '';
chip.uart[0].onByte = (letter) => {
    if (letter !== 10) {
        line += String.fromCharCode(letter);
        return;
    }
    if (line === 'frame') {
        record();
        out.push(Buffer.from([0x40, 0]));
        frames++;
        process.stderr.write(`frame ${frames}: ${clocks - frame.began} clocks, ${frame.sent} bytes, ${frame.beneath} of them beneath the drawing\n`);
        [frame.began, frame.sent, frame.beneath] = [clocks, 0, 0];
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
    const cycles = core.executeInstruction() || 1;
    clocks += cycles;
    chip.clock.tick(cycles * nanoseconds);
    instructions++;
    if (core.SP < lowest) { lowest = core.SP; }
    if (lowest < statics) { fail(`the stack has grown into what lies beneath it, at ${statics.toString(16)}`); }
}
const memory = statics - MEMORY + top - lowest;
process.stderr.write(`${frames} frames, ${instructions} instructions, ${memory} bytes of memory, ${top - lowest} of them stack, ${chip.clkSys} Hz\n`);
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
