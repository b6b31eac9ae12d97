// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Messages written here byte by byte, as docs/viewer_protocol.md lays them out, and read by the page.
import { describe, expect, test } from "vitest";
import {
  holdCommand,
  jointsCommand,
  jsonCommand,
  meshCommand,
  pickCommand,
  rateCommand,
  shellCommand,
  sliceCommand,
  toolCommand,
  withId,
} from "../../src/protocol/command";
import { readFeel, readHello } from "../../src/protocol/hello";
import { Json } from "../../src/protocol/json";
import { Message, UnreadableMessage } from "../../src/protocol/message";
import { readRecording } from "../../src/protocol/recording";
import { readMesh, readShellPart, readSlice } from "../../src/protocol/shapes";
import { isSameMoment, readPoints, readSnapshot } from "../../src/protocol/snapshot";
import { seeded } from "./seeded";

type Width = "u8" | "u16" | "u32" | "i32" | "u64" | "f32" | "f64";
const sizes: Record<Width, number> = { u8: 1, u16: 2, u32: 4, i32: 4, u64: 8, f32: 4, f64: 8 };

/** Numbers at offsets, in a message of a type and a length. */
function message(type: number, length: number, numbers: [at: number, width: Width, ...values: number[]][]): ArrayBuffer {
  const bytes = new ArrayBuffer(length);
  const view = new DataView(bytes);
  view.setUint16(0, type, true);
  view.setUint16(2, 1, true);
  view.setUint32(4, 77, true);
  for (const [at, width, ...values] of numbers) {
    values.forEach((value, n) => {
      const place = at + n * sizes[width];
      if (width === "u8") view.setUint8(place, value);
      else if (width === "u16") view.setUint16(place, value, true);
      else if (width === "u32") view.setUint32(place, value, true);
      else if (width === "i32") view.setInt32(place, value, true);
      else if (width === "u64") view.setBigUint64(place, BigInt(value), true);
      else if (width === "f32") view.setFloat32(place, value, true);
      else view.setFloat64(place, value, true);
    });
  }
  return bytes;
}

// Two joints, three links, two points, four bins.
const [n, l, p, b] = [2, 3, 2, 4];
const links = 264 + 24 * n;
const snapshot = message(3, links + 28 * l + 16 * p + 4 * b, [
  [8, "u32", 5, 9],
  [16, "f64", 12.5],
  [24, "u64", 12500, 1, 2, 3],
  [56, "u16", n, l, p, b],
  [64, "u8", 2, 1, 1, 3, 0, 1],
  [70, "u16", 41],
  [72, "f64", 0.75, 1, -2],
  [104, "f32", 1, 2, 3, 4, 5, 6],
  [128, "f32", 0.1, 0.2, 0.3, 0, 0, 0, 1],
  [156, "f32", 0.5, 0, -0.5],
  [168, "f32", 7, 8, 0.5, 9, 10, 11, 12, 13],
  [200, "f32", 0.25, 0.5, 0.75],
  [212, "i32", 3, 1, -1, 1, 2],
  [232, "f32", 0.5, 0.031, 0.4],
  [244, "f32", 13, 17, 40, 22, 1.5],
  [264, "f64", 0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
  [links, "f32", ...Array.from({ length: 7 * l }, (_, at) => at)],
  [links + 28 * l, "f32", 32, 0, 1, 2, 3, 4, 5, 6],
]);

describe("a snapshot", () => {
  test("is read where the page says that its numbers stand", () => {
    const read = readSnapshot(new Message(snapshot));
    expect(read).toMatchObject({
      generation: 5,
      number: 9,
      time: 12.5,
      ticks: 12500,
      skipped: 1,
      missed: 2,
      refused: 3,
      status: 2,
      driver: 1,
      limiterMode: 1,
      limit: 3,
      passive: true,
      pointsFelt: 41,
      energy: 0.75,
      masterForce: 7,
      power: 8,
      scale: 0.5,
      felt: 11,
      lag: 12,
      highestViscosity: 13,
      tickP50: 13,
      tickP99: 17,
      tickLargest: 40,
      lateness: 22,
      recordingTime: 1.5,
    });
    expect(read.reason).toMatchObject({ point: 3, link: 1, object: -1, kind: 1, rank: 2, share: 0.5 });
    expect(read.reason.distance).toBeCloseTo(0.031, 6);
    expect([...read.force, ...read.moment]).toEqual([1, 2, 3, 4, 5, 6]);
    expect([...read.q, ...read.qd, ...read.tau]).toEqual([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    expect([...read.links]).toEqual(Array.from({ length: 21 }, (_, at) => at));
    expect([...read.pointViscosity, ...read.pointDrag]).toEqual([32, 0, 1, 2, 3, 4, 5, 6]);
  });

  test("that differs in nothing that is drawn is the same moment", () => {
    const [one, other] = [snapshot.slice(0), snapshot.slice(0)].map((bytes) => readSnapshot(new Message(bytes)));
    expect(isSameMoment(one!, other!)).toBe(true);
    other!.q[1] = 9;
    expect(isSameMoment(one!, other!)).toBe(false);
    expect(isSameMoment(one!, null)).toBe(false);
  });
});

test("points, meshes, shells and slices are read from their offsets", () => {
  const points = message(2, 16 + 24 * 2, [
    [8, "u32", 2, 900],
    [16, "u32", 1, 4],
    [24, "f32", 1, 2, 3, 4, 5, 6, 0.5, 0.25],
    [56, "u32", 17, 899],
  ]);
  const read = readPoints(new Message(points));
  expect([[...read.link], [...read.place], [...read.area], [...read.index]]).toEqual([
    [1, 4],
    [1, 2, 3, 4, 5, 6],
    [0.5, 0.25],
    [17, 899],
  ]);

  const mesh = message(4, 24 + 36 + 12, [
    [8, "u32", 5],
    [12, "u8", 1, 1],
    [14, "u16", 6],
    [16, "u32", 3, 1],
    [24, "f32", 0, 0, 0, 1, 0, 0, 0, 1, 0],
    [60, "u32", 0, 1, 2],
  ]);
  expect(readMesh(new Message(mesh))).toMatchObject({ isLink: true, index: 6, simplified: true });
  new DataView(mesh).setUint32(68, 3, true);
  expect(() => readMesh(new Message(mesh))).toThrow(UnreadableMessage);

  const shell = message(5, 32 + 16, [
    [8, "u32", 5],
    [12, "u16", 3, 2],
    [16, "u32", 0, 2, 1],
    [32, "u16", 10, 20, 30, 4, 5],
    [42, "u8", 3],
    [44, "u16", 7],
  ]);
  const part = readShellPart(new Message(shell));
  expect([part.rank, part.step, part.part, part.parts]).toEqual([3, 2, 0, 2]);
  expect([...part.quads]).toEqual([10 | (20 << 16), 30 | (4 << 16), 5 | (3 << 16), 7]);

  const slice = message(6, 40 + 2 * 6, [
    [8, "u32", 5],
    [12, "u8", 1, 2],
    [14, "u16", 4],
    [16, "i32", 60],
    [20, "u32", 3, 2],
    [32, "f64", 1.11],
    [40, "u16", 0, 1, 2, 300, 4, 5],
  ]);
  const cut = readSlice(new Message(slice));
  expect(cut).toMatchObject({ axis: 1, step: 4, index: 60, width: 3, height: 2, where: 1.11 });
  expect([...cut.codes]).toEqual([0, 1, 2, 300, 4, 5]);
});

test("a recording is read with its columns, statuses, reasons and poses", () => {
  const text = new TextEncoder().encode(
    JSON.stringify({
      name: "felt.csv",
      recording: 2,
      duration: 1,
      rows: 2,
      columns: ["fx"],
      status: [["ok", 0]],
      reasons: [[0, "link_5", "vessel", 2, 31], [1, null]],
    }),
  );
  const start = Math.ceil((24 + text.length) / 8) * 8;
  const bytes = message(9, start + 16 + 16 + 8 + 28, [
    [8, "u32", text.length, 2, 1, 1],
    [24, "u8", ...text],
    [start, "f64", 0, 1, 5, NaN, 0.5],
    [start + 40, "f32", 1, 2, 3, 0, 0, 0, 1],
  ]);
  const read = readRecording(new Message(bytes));
  expect([...read.t]).toEqual([0, 1]);
  expect([...read.columns.get("fx")!]).toEqual([5, NaN]);
  expect(read.statuses).toEqual([{ row: 0, status: "ok" }]);
  expect(read.reasons.map(({ reason }) => reason?.object ?? null)).toEqual(["vessel", null]);
  expect([[...read.frames], [...read.poses]]).toEqual([[0.5], [1, 2, 3, 0, 0, 0, 1]]);
});

test("every message cut short is refused with a sentence, wherever it is cut", () => {
  for (let length = 0; length < snapshot.byteLength - 4 * b; ++length) {
    expect(() => readSnapshot(new Message(snapshot.slice(0, length)))).toThrow(UnreadableMessage);
  }
});

test("10,000 random messages are read or refused, and nothing else happens", () => {
  const random = seeded(2026);
  const readers = [readSnapshot, readPoints, readMesh, readShellPart, readSlice, readRecording];
  for (let trial = 0; trial < 10000; ++trial) {
    const bytes = new Uint8Array(Math.floor(random() * 600));
    for (let at = 0; at < bytes.length; ++at) bytes[at] = random() < 0.7 ? 0 : Math.floor(256 * random());
    if (bytes.length >= 4) bytes.set([1, 0], 2);
    for (const read of readers) {
      try {
        read(new Message(bytes.buffer));
      } catch (error) {
        if (!(error instanceof UnreadableMessage)) throw new Error(`trial ${trial}: ${String(error)}`);
      }
    }
  }
});

test("another version of the protocol is refused with what to do", () => {
  const bytes = message(3, 8, []);
  new DataView(bytes).setUint16(2, 2, true);
  expect(() => new Message(bytes)).toThrow(/reload the page/);
});

test("HELLO and FEEL say which part is not as it should be", () => {
  expect(() => readHello(new Json({ generation: 1, field: {} }, "HELLO"))).toThrow("HELLO.field.records is not an object");
  expect(() => readFeel(new Json({ memory: "none", direction: "all" }, "FEEL"))).toThrow("FEEL.viscosity is not a list");
});

test("commands stand where the server reads them", () => {
  const seen = (command: ArrayBuffer): DataView => new DataView(withId(command, 42));
  const slice = seen(sliceCommand(2, 0.95, 512));
  expect([slice.getUint16(0, true), slice.getUint16(2, true), slice.getUint32(4, true)]).toEqual([65, 1, 42]);
  expect([slice.getUint8(8), slice.getUint16(10, true), slice.getFloat64(16, true)]).toEqual([2, 512, 0.95]);
  const tool = seen(toolCommand([1, 2, 3, 0, 0, 0, 1], true));
  expect([tool.byteLength, tool.getUint8(8), tool.getUint8(9), tool.getFloat64(16, true)]).toEqual([72, 1, 0, 1]);
  expect(seen(toolCommand([1, 2, 3, 0, 0, 0, 1], false)).getUint8(9)).toBe(1);
  const joints = seen(jointsCommand([0.5, -0.5]));
  expect([joints.getUint8(8), joints.getUint16(10, true), joints.getFloat64(24, true)]).toEqual([2, 2, -0.5]);
  expect([seen(holdCommand()).byteLength, seen(holdCommand()).getUint8(8)]).toEqual([16, 0]);
  const shell = seen(shellCommand(3, 2));
  expect([shell.getUint16(8, true), shell.getUint16(10, true)]).toEqual([3, 2]);
  const mesh = seen(meshCommand("link", 300));
  expect([mesh.getUint8(8), mesh.getUint16(10, true)]).toEqual([1, 300]);
  expect(seen(pickCommand([1, 2, 3])).getFloat64(24, true)).toBe(3);
  expect(seen(rateCommand(60)).getUint16(8, true)).toBe(60);
  const text = new TextDecoder().decode(jsonCommand(69, { memory: "rising" }).slice(8));
  expect(JSON.parse(text)).toEqual({ memory: "rising" });
});
