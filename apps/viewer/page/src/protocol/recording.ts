// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// RECORDING: a motion and what was felt in it, whole, so that the page can scrub without asking.
import { Json } from "./json";
import type { Message } from "./message";

export interface RecordedReason {
  link: string;
  object: string;
  rank: number;
  distanceMm: number;
}

export interface Recording {
  name: string;
  /** The server's number of it, for FOLLOW. */
  number: number;
  duration: number;
  t: Float64Array;
  columns: Map<string, Float64Array>;
  /** From its row on, rows rising. */
  statuses: { row: number; status: string }[];
  reasons: { row: number; reason: RecordedReason | null }[];
  /** Times of the poses, and the poses of all links, shape (frames, links, 7). */
  frames: Float64Array;
  poses: Float32Array;
  links: number;
}

export function readRecording(message: Message): Recording {
  const [m, rows, frames, links] = [message.u32(8), message.u32(12), message.u32(16), message.u32(20)];
  const json = new Json(message.json(24, m), "recording");
  const start = Math.ceil((24 + m) / 8) * 8;
  const names = json.at("columns").texts();
  const column = (n: number): Float64Array => message.f64s(start + 8 * rows * n, rows);
  const times = start + 8 * rows * (1 + names.length);
  return {
    name: json.at("name").text(),
    number: json.at("recording").number(),
    duration: json.at("duration").number(),
    t: column(0),
    columns: new Map(names.map((name, n) => [name, column(n + 1)])),
    statuses: json.at("status").listOrNone((entry) => {
      const [status, row] = entry.list((part) => part);
      return { status: status?.textOr("") ?? "", row: row?.numberOr(0) ?? 0 };
    }),
    reasons: json.at("reasons").listOrNone((entry) => {
      const [row, link, object, rank, distance] = entry.list((part) => part);
      const name = link?.textOr(null) ?? null;
      return {
        row: row?.numberOr(0) ?? 0,
        reason:
          name === null
            ? null
            : {
                link: name,
                object: object?.textOr("") ?? "",
                rank: rank?.numberOr(0) ?? 0,
                distanceMm: distance?.numberOr(NaN) ?? NaN,
              },
      };
    }),
    frames: message.f64s(times, frames),
    poses: message.f32s(times + 8 * frames, 7 * links * frames),
    links,
  };
}
