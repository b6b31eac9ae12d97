// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// HELLO, FEEL and FILES: what the field, the arm and the way it feels are.
import { Json } from "./json";

export type VoxelKind = "empty" | "neighbour" | "inner" | "boundary";
export const voxelKinds: readonly VoxelKind[] = ["empty", "neighbour", "inner", "boundary"];

export type Vec3 = [number, number, number];
/** x, y, z [m] and a quaternion x, y, z, w. */
export type Pose = readonly number[];

export interface FieldObject {
  name: string;
  shape: string;
  m: number;
  q: number;
  boundMm: number;
  closed: boolean;
  triangles: number;
}

export interface VoxelRecord {
  kind: VoxelKind;
  rank: number;
  object: number;
}

export interface Field {
  name: string;
  bytes: number;
  voxelSize: number;
  origin: Vec3;
  dims: Vec3;
  ranks: number;
  keepsDistance: boolean;
  objects: FieldObject[];
  records: VoxelRecord[];
  voxels: { boundary: number; inner: number; neighbour: number };
}

export interface Coordinate {
  name: string;
  prismatic: boolean;
  lower: number | null;
  upper: number | null;
}

export interface Robot {
  name: string;
  toolLink: number;
  links: { name: string; mesh: boolean }[];
  coordinates: Coordinate[];
  probe: boolean;
  points: number;
  remarks: string[];
}

export interface Coding {
  coding: number[];
  skin: number;
}

export interface Feel {
  memory: string;
  direction: string;
  traversal: string;
  device: string | null;
  mode: string;
  limiter: string;
  codings: Map<string, Coding>;
  /** By voxel code [N·s/m³]. */
  viscosity: number[];
}

export interface Files {
  scenes: string[];
  meshes: string[];
  recordings: string[];
  fields: string[];
}

export interface Hello {
  version: string;
  generation: number;
  field: Field;
  robot: Robot;
  feel: Feel;
  scene: SceneMessage | null;
  files: Files;
  devices: string[];
  memories: string[];
  codings: string[];
  uploadBytes: number;
}

/** A scene as it stands in its file; what the page does not edit is handed back as it came. */
export interface SceneMessage {
  name: string;
  scene: Record<string, unknown>;
}

function vec3(json: Json): Vec3 {
  return json.numbers(3) as Vec3;
}

function field(json: Json): Field {
  const records = json.at("records");
  const ranks = records.at("rank").numbers();
  const owners = records.at("object").numbers();
  return {
    name: json.at("name").text(),
    bytes: json.at("bytes").numberOr(0),
    voxelSize: json.at("voxel_size").number(),
    origin: vec3(json.at("origin")),
    dims: vec3(json.at("dims")),
    ranks: json.at("ranks").number(),
    keepsDistance: json.at("keeps_distance").flag(),
    objects: json.at("objects").list((object) => ({
      name: object.at("name").text(),
      shape: object.at("shape").textOr(""),
      m: object.at("m").numberOr(0),
      q: object.at("q").number(),
      boundMm: object.at("bound_mm").numberOr(0),
      closed: object.at("closed").flag(),
      triangles: object.at("triangles").numberOr(0),
    })),
    records: records.at("kind").list((kind) => kind.number()).map((kind, code) => ({
      kind: voxelKinds[kind] ?? "empty",
      rank: ranks[code] ?? 0,
      object: owners[code] ?? 0,
    })),
    voxels: {
      boundary: json.at("voxels").at("boundary").numberOr(0),
      inner: json.at("voxels").at("inner").numberOr(0),
      neighbour: json.at("voxels").at("neighbour").numberOr(0),
    },
  };
}

function robot(json: Json): Robot {
  return {
    name: json.at("name").textOr("arm"),
    toolLink: json.at("tool_link").number(),
    links: json.at("links").list((link) => ({
      name: link.at("name").text(),
      mesh: link.at("mesh").flag(),
    })),
    coordinates: json.at("coordinates").list((coordinate) => ({
      name: coordinate.at("name").text(),
      prismatic: coordinate.at("type").textOr("") === "prismatic",
      lower: coordinate.at("lower").numberOr(null),
      upper: coordinate.at("upper").numberOr(null),
    })),
    probe: json.at("probe").flag(),
    points: json.at("points").numberOr(0),
    remarks: json.at("remarks").texts(),
  };
}

export function readFeel(json: Json): Feel {
  return {
    memory: json.at("memory").text(),
    direction: json.at("direction").text(),
    traversal: json.at("traversal").textOr("swept"),
    device: json.at("device").textOr(null),
    mode: json.at("mode").textOr("strict"),
    limiter: json.at("limiter").textOr(""),
    codings: new Map(
      json
        .at("codings")
        .entries()
        .map(([name, coding]) => [
          name,
          { coding: coding.at("coding").numbers(), skin: coding.at("skin").number() },
        ]),
    ),
    viscosity: json.at("viscosity").numbers(),
  };
}

export function readFiles(json: Json): Files {
  return {
    scenes: json.at("scenes").texts(),
    meshes: json.at("meshes").texts(),
    recordings: json.at("recordings").texts(),
    fields: json.at("fields").texts(),
  };
}

export function readScene(json: Json): SceneMessage | null {
  if (json.isNull) return null;
  const scene = json.at("scene");
  return { name: json.at("name").textOr("scene.yaml"), scene: Object.fromEntries(
      scene.entries().map(([key, value]) => [key, value.raw()]),
    ) };
}

export function readHello(json: Json): Hello {
  return {
    version: json.at("version").textOr(""),
    generation: json.at("generation").number(),
    field: field(json.at("field")),
    robot: robot(json.at("robot")),
    feel: readFeel(json.at("feel")),
    scene: readScene(json.at("scene")),
    files: readFiles(json.at("files")),
    devices: json.at("devices").texts(),
    memories: json.at("memories").texts(),
    codings: json.at("codings").texts(),
    uploadBytes: json.at("limits").at("upload_bytes").numberOr(0),
  };
}
