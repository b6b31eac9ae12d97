// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Brings a file to the server and reads what it says about it.
import { Json } from "../protocol/json";
import type { Session } from "../protocol/session";
import type { Vec3 } from "../protocol/hello";

export interface UploadedMesh {
  mesh: string;
  triangles: number;
  closed: boolean;
  verdict: string;
  problems: string[];
  /** In the file's own unit, whatever that is. */
  size: Vec3;
}

/** Errors: throws Error with the server's sentence. */
async function put(session: Session, file: File): Promise<Json> {
  const most = session.hello?.uploadBytes ?? 0;
  if (most > 0 && file.size > most) {
    throw new Error(`${file.name} has ${file.size} bytes; the server takes ${most} at most`);
  }
  const answer = await fetch(session.addressOf("upload", file.name), { method: "PUT", body: file });
  if (!answer.ok) throw new Error(await answer.text());
  return new Json(await answer.json(), "upload");
}

export async function uploadMesh(session: Session, file: File): Promise<UploadedMesh> {
  const json = await put(session, file);
  return {
    mesh: json.at("mesh").text(),
    triangles: json.at("triangles").numberOr(0),
    closed: json.at("closed").flag(),
    verdict: json.at("verdict").textOr("ok"),
    problems: json.at("problems").listOrNone((problem) => {
      return problem.textOr(null) ?? `${problem.at("count").numberOr("")} ${problem.at("what").textOr("")}`.trim();
    }),
    size: json.at("size").numbers(3) as Vec3,
  };
}

/** @return the recording's name on the server */
export async function uploadRecording(session: Session, file: File): Promise<string> {
  return (await put(session, file)).at("recording").text();
}
