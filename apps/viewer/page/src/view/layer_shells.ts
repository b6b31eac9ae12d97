// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Layers as translucent shells, one for each rank, and the skin of the voxels (rank 0) where an
// object has no mesh. Shells are drawn from the inside out, each only by its nearest surface, so
// that what lies behind shines through once for each rank, in the same order from everywhere.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  IntType,
  Mesh,
  Vector3,
  type ShaderMaterial,
} from "three";
import { rankColour } from "../colour/rank_palette";
import type { Field } from "../protocol/hello";
import type { ShellPart } from "../protocol/shapes";
import type { Cut } from "./material";
import { firstQuadHit, type QuadHit, type Ray } from "./quad";
import { shellMaterial, type HiddenObjects } from "./shell_material";

interface Shell {
  cell: number;
  parts: Uint32Array[];
  group: Group;
  colours: ShaderMaterial[];
}

const skinColour = [0.6, 0.63, 0.67] as const;

/** Four corners to a quad, which the shader tells apart by their number. (Instances of one quad would
 * need no copies, but graphics cards, and software renderers more so, are slow at tiny instances.) */
function geometryOf(quads: Uint32Array): BufferGeometry {
  const count = Math.floor(quads.length / 4);
  const words = new Uint32Array(16 * count);
  const corners = new Uint32Array(6 * count);
  for (let n = 0; n < count; ++n) {
    for (let word = 0; word < 16; ++word) words[16 * n + word] = quads[4 * n + (word & 3)]!;
    const first = 4 * n;
    corners.set([first, first + 1, first + 2, first, first + 2, first + 3], 6 * n);
  }
  const geometry = new BufferGeometry();
  const attribute = new BufferAttribute(words, 4);
  attribute.gpuType = IntType;
  geometry.setAttribute("quad", attribute);
  geometry.setIndex(new BufferAttribute(corners, 1));
  return geometry;
}

export class LayerShells {
  readonly group = new Group();
  private readonly shells = new Map<number, Shell>();
  private opacity = 0.22;

  constructor(
    private readonly field: Field,
    private readonly hidden: HiddenObjects,
    private readonly cut: Cut,
  ) {}

  has(rank: number): boolean {
    return this.shells.has(rank);
  }

  /** Puts a shell in place; an empty list of parts is a rank that has no surface. */
  add(rank: number, parts: readonly ShellPart[]): void {
    const cell = this.field.voxelSize * (parts[0]?.step ?? 1);
    const shell: Shell = { cell, parts: parts.map((part) => part.quads), group: new Group(), colours: [] };
    const look = {
      colour: rank === 0 ? skinColour : rankColour(rank, this.field.ranks),
      opacity: rank === 0 ? 1 : this.opacity,
      origin: new Vector3(...this.field.origin),
      cell,
      hidden: this.hidden,
      cut: this.cut,
    };
    const colour = shellMaterial(look, false);
    shell.colours.push(colour);
    for (const quads of shell.parts) {
      if (quads.length === 0) continue;
      const geometry = geometryOf(quads);
      if (rank > 0) {
        const depth = new Mesh(geometry, shellMaterial(look, true));
        depth.renderOrder = 10 + 2 * rank;
        shell.group.add(depth);
      }
      const mesh = new Mesh(geometry, colour);
      mesh.renderOrder = rank > 0 ? 11 + 2 * rank : 0;
      shell.group.add(mesh);
    }
    for (const mesh of shell.group.children) mesh.frustumCulled = false; // its bounds are in the words
    this.shells.set(rank, shell);
    this.group.add(shell.group);
  }

  show(rank: number, shown: boolean): void {
    const shell = this.shells.get(rank);
    if (shell) shell.group.visible = shown;
  }

  setOpacity(opacity: number): void {
    this.opacity = opacity;
    for (const [rank, { colours }] of this.shells) {
      if (rank === 0) continue;
      for (const material of colours) material.uniforms.opacity!.value = opacity;
    }
  }

  /** The nearest surface of a shown shell on a ray, with its rank. */
  hit(ray: Ray, counts: (at: number) => boolean): (QuadHit & { rank: number }) | null {
    let best: (QuadHit & { rank: number }) | null = null;
    const origin = this.field.origin;
    for (const [rank, shell] of this.shells) {
      if (!shell.group.visible) continue;
      for (const quads of shell.parts) {
        const hit = firstQuadHit(ray, quads, origin, shell.cell, (object, at) => {
          return !this.hidden.has(object) && counts(at);
        });
        if (hit && (!best || hit.at < best.at)) best = { ...hit, rank };
      }
    }
    return best;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.group.traverse((node) => {
      if (!(node instanceof Mesh)) return;
      (node.geometry as BufferGeometry).dispose();
      (node.material as ShaderMaterial).dispose();
    });
  }
}
