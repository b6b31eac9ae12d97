// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Opens a recording as Foxglove does, by its index, with the schemas it carries, and holds every
// message against the CSV of the same replay.
//
//   node read.mjs RECORDING.mcap SAME.csv

import { open, readFile } from "node:fs/promises";
import assert from "node:assert/strict";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";

const [, , recording, csv] = process.argv;
await zstd.isLoaded;
const decompressHandlers = { zstd: (bytes, size) => zstd.decompress(bytes, Number(size)) };

const lines = (await readFile(csv, "utf8")).trimEnd().split("\n");
const header = lines[0].split(",");
const rows = lines.slice(1).map((line) => {
  const cells = line.split(",");
  return Object.fromEntries(header.map((name, n) => [name, cells[n]]));
});
const joints = header.filter((name) => name.startsWith("q_")).map((name) => name.slice(2));

const file = await open(recording);
const reader = await McapIndexedReader.Initialize({
  readable: new FileHandleReadable(file),
  decompressHandlers,
});
assert.equal(reader.header.profile, "ros2");

const decoders = new Map();
for (const schema of reader.schemasById.values()) {
  assert.equal(schema.encoding, "ros2msg");
  const text = new TextDecoder().decode(schema.data);
  decoders.set(schema.id, new MessageReader(parse(text, { ros2: true })));
}
const topics = new Map();
let previous = 0n;
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const said = decoders.get(channel.schemaId).readMessage(message.data);
  assert.ok(message.logTime >= previous, "messages come in the order of time");
  previous = message.logTime;
  topics.set(channel.topic, [...(topics.get(channel.topic) ?? []), said]);
}

// By the index, by its statistics and by reading from the start: as many messages.
let counted = 0;
for (const all of topics.values()) counted += all.length;
assert.equal(reader.statistics.messageCount, BigInt(counted));
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(new Uint8Array(await readFile(recording)));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
assert.ok(stream.done());
assert.equal(streamed, counted);

const near = (a, b, slack, what) => assert.ok(Math.abs(a - b) <= slack, `${what}: ${a} is not ${b}`);
const states = topics.get("/joint_states");
const efforts = topics.get("/vicinity/joint_efforts");
const wrenches = topics.get("/vicinity/wrench");
assert.equal(states.length, rows.length);
assert.equal(efforts.length, rows.length);
assert.equal(wrenches.length, rows.length);
rows.forEach((row, k) => {
  const { header: head, name, position } = states[k];
  near(head.stamp.sec + 1e-9 * head.stamp.nanosec, Number(row.t), 1e-8, `time ${k}`);
  assert.deepEqual(name, joints);
  joints.forEach((joint, n) => {
    near(position[n], Number(row[`q_${joint}`]), 1e-8, `position ${k}`);
    near(efforts[k].effort[n], Number(row[`tau_${joint}`]), 1e-8, `torque ${k}`);
  });
  // Lengths do not depend on the axes.
  const { x, y, z } = wrenches[k].wrench.force;
  const force = Math.hypot(Number(row.fx), Number(row.fy), Number(row.fz));
  near(Math.hypot(x, y, z), force, 1e-8, `force ${k}`);
});
const words = new Set(rows.map((row) => row.status));
for (const { status } of topics.get("/diagnostics")) assert.ok(words.has(status[0].message));
await file.close();
console.log(`${counted} messages on ${topics.size} topics, as the CSV has them`);
