// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A cut through the field, as in the paper's figures, standing where it was cut. What lies on the
// camera's side of it can be cut away.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  Group,
  LineLoop,
  Mesh,
  NearestFilter,
  Vector4,
  type Vector3,
} from "three";
import type { Field, Vec3 } from "../protocol/hello";
import type { Axis, SliceAnswer } from "../protocol/shapes";
import type { Look } from "./look";
import { flatMaterial, noCut, sliceMaterial, type Cut } from "./material";

/** The four corners of a plane across the workspace, and the axes that lie in it. */
function corners(field: Field, axis: Axis, where: number): Float32Array {
  const [u, v] = [0, 1, 2].filter((n) => n !== axis) as [Axis, Axis];
  const high = (n: Axis): number => field.origin[n] + field.voxelSize * field.dims[n];
  return new Float32Array(
    [
      [field.origin[u], field.origin[v]],
      [high(u), field.origin[v]],
      [high(u), high(v)],
      [field.origin[u], high(v)],
    ].flatMap(([a, b]) => {
      const corner: Vec3 = [0, 0, 0];
      corner[axis] = where;
      corner[u] = a!;
      corner[v] = b!;
      return corner;
    }),
  );
}

export class SlicePlane {
  readonly group = new Group();
  /** Cuts away what is in front of the slice, if anything is. */
  readonly cut: Cut = noCut();

  axis: Axis = 1;
  where = 0;
  private cutsAway = true;
  private answer: SliceAnswer | null = null;
  private readonly geometry = new BufferGeometry();
  private readonly outline = new BufferGeometry();
  private readonly pixels: { value: DataTexture | null } = { value: null };
  private readonly material = sliceMaterial(this.pixels);
  private readonly ground = flatMaterial({ depthWrite: false });
  private readonly frame = flatMaterial();

  constructor(private readonly field: Field) {
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.geometry.setAttribute("uv", new BufferAttribute(new Float32Array(8), 2));
    const painted = new Mesh(this.geometry, this.material);
    const ground = new Mesh(this.geometry, this.ground);
    ground.renderOrder = 2; // first, so that only empty space lets it through
    painted.renderOrder = 3;
    this.group.add(painted, ground, new LineLoop(this.outline, this.frame));
  }

  get shown(): boolean {
    return this.group.visible;
  }

  show(shown: boolean): void {
    this.group.visible = shown;
  }

  /** The cut that is shown; its pixels come with `paint`. */
  place(answer: SliceAnswer): void {
    this.answer = answer;
    const places = new BufferAttribute(corners(this.field, answer.axis, answer.where), 3);
    for (const geometry of [this.geometry, this.outline]) {
      geometry.setAttribute("position", places);
      geometry.computeBoundingSphere();
    }
    // The last sample may stand for fewer voxels than the others: the texture reaches beyond.
    const across = ([0, 1, 2] as Axis[]).filter((n) => n !== answer.axis);
    const reach = (n: number, samples: number): number =>
      samples > 0 ? this.field.dims[across[n]!]! / (samples * answer.step) : 1;
    const [u, v] = [reach(0, answer.width), reach(1, answer.height)];
    const uv = new Float32Array([0, 0, u, 0, u, v, 0, v]);
    this.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  }

  /** @param pixels shape (height, width, 4), of the cut that was placed */
  paint(pixels: Uint8Array<ArrayBuffer>, width: number, height: number): void {
    this.pixels.value?.dispose();
    const texture = new DataTexture(pixels, Math.max(1, width), Math.max(1, height));
    texture.magFilter = NearestFilter;
    texture.minFilter = NearestFilter;
    texture.needsUpdate = true;
    this.pixels.value = texture;
  }

  get latest(): SliceAnswer | null {
    return this.answer;
  }

  cutAway(cutsAway: boolean): void {
    this.cutsAway = cutsAway;
  }

  /** Turns the cut-away side towards the camera. Called before each frame. */
  face(camera: Vector3): void {
    const plane = this.cut.value.set(0, 0, 0, 1);
    const { answer } = this;
    if (!answer || !this.cutsAway || !this.group.visible) return;
    const towards = Math.sign(camera.getComponent(answer.axis) - answer.where) || 1;
    plane.setComponent(answer.axis, -towards);
    // A hair behind the slice, so that it is not fought over.
    plane.w = towards * answer.where - 0.02 * this.field.voxelSize;
  }

  /** Whether a place is not drawn, as the slice was turned for the last frame. */
  cutsAwayAt({ x, y, z }: Vector3): boolean {
    return this.cut.value.dot(new Vector4(x, y, z, 1)) < 0;
  }

  setLook(look: Look, theme: "dark" | "light"): void {
    this.frame.setColour(look.outline);
    if (theme === "dark") this.ground.setColour("#dfe7f0", 0.07);
    else this.ground.setColour("#ffffff", 0.55);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    this.outline.dispose();
    this.pixels.value?.dispose();
    for (const material of [this.material, this.ground, this.frame]) material.dispose();
  }
}
