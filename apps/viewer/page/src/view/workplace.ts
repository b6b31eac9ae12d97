// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Everything that is drawn of one field and one arm: fetched when a field comes into place, thrown
// away when another one does.
import { Box3, BufferAttribute, BufferGeometry, Group, Mesh, Points, Vector3 } from "three";
import type { Connection } from "../protocol/connection";
import type { Feel, Hello } from "../protocol/hello";
import { meshCommand, shellCommand, sliceCommand } from "../protocol/command";
import { fromServer } from "../protocol/message";
import { readMesh, readShellPart, readSlice, type Axis } from "../protocol/shapes";
import type { BodyPoints, Snapshot } from "../protocol/snapshot";
import { Arm } from "./arm";
import { FeltPoints, pointMaterial } from "./felt_points";
import { ForceArrow } from "./force_arrow";
import { LayerShells } from "./layer_shells";
import { looks, type Theme } from "./look";
import { ObjectMeshes } from "./object_meshes";
import { flatMaterial, litMaterial, noCut, sliceMaterial } from "./material";
import { HiddenObjects, shellMaterial } from "./shell_material";
import { largestViscosity, paintSlice, sliceColours, type SliceColouring } from "./slice_paint";
import { SlicePlane } from "./slice_plane";
import type { Stage } from "./stage";

/** What of a workplace is shown; kept while fields come and go. */
export interface Shown {
  shells: Set<number>;
  opacity: number;
  slice: boolean;
  cutAway: boolean;
  colouring: SliceColouring;
  objects: boolean;
  arm: boolean;
  points: boolean;
  drag: boolean;
  metresPerNewton: number;
}

/** One of each kind of thing that a workplace is drawn with. */
export function samplesOfWorkplaces(): Group {
  const vectors = new BufferAttribute(new Float32Array(), 3);
  const bare = new BufferGeometry().setAttribute("position", vectors);
  const surface = new BufferGeometry().setAttribute("position", vectors).setAttribute("normal", vectors);
  const shell = { colour: [0, 0, 0], origin: new Vector3(), cell: 1, hidden: new HiddenObjects(0), cut: noCut() } as const;
  return new Group().add(
    new Mesh(surface, litMaterial()),
    new Mesh(bare, flatMaterial()),
    new Mesh(bare, sliceMaterial({ value: null })),
    new Points(bare, pointMaterial(1)),
    new Mesh(new BufferGeometry(), shellMaterial({ ...shell, opacity: 1 }, false)),
    new Mesh(new BufferGeometry(), shellMaterial({ ...shell, opacity: 0.5 }, false)),
  );
}

export class Workplace {
  readonly root = new Group();
  readonly hidden: HiddenObjects;
  readonly objects: ObjectMeshes;
  readonly shells: LayerShells;
  readonly slice: SlicePlane;
  readonly arm: Arm;
  /** All of the workspace [m]. */
  readonly box: Box3;
  private points: FeltPoints | null = null;
  private readonly arrow: ForceArrow;
  private feel: Feel;
  private theme: Theme = "dark";
  private readonly asked = new Map<number, Promise<void>>(); // shells, by rank
  private wantedSlice: { axis: Axis; where: number } | null = null;
  private sliceIsUnderWay = false;
  private paintIsDue = false;
  private disposed = false;
  private armGivesWay = false;

  constructor(
    readonly hello: Hello,
    private readonly stage: Stage,
    private readonly connection: Connection,
    readonly shown: Shown,
    private readonly onTrouble: (error: unknown) => void,
    private readonly onSlice: () => void,
  ) {
    const { field, robot } = hello;
    const lo = new Vector3(...field.origin);
    const hi = lo.clone().add(new Vector3(...field.dims).multiplyScalar(field.voxelSize));
    this.box = new Box3(lo, hi);
    const size = hi.distanceTo(lo);
    this.feel = hello.feel;
    this.hidden = new HiddenObjects(field.objects.length);
    this.slice = new SlicePlane(field);
    this.objects = new ObjectMeshes(this.slice.cut);
    this.shells = new LayerShells(field, this.hidden, this.slice.cut);
    this.arm = new Arm(robot);
    this.arrow = new ForceArrow(size / 550);
    this.root.add(
      this.objects.group,
      this.shells.group,
      this.slice.group,
      this.arm.group,
      this.arrow.group,
    );
    stage.scene.add(this.root);
  }

  /** Fetches meshes, the shells that are shown and the slice; done when all are there. */
  async load(): Promise<void> {
    const { field, robot } = this.hello;
    const links = robot.links.flatMap((link, n) => (link.mesh ? [this.loadMesh("link", n)] : []));
    const slice = this.cut(this.slice.axis, this.slice.where);
    const meshes = await Promise.all(field.objects.map((_, n) => this.loadMesh("object", n)));
    const skin = meshes.every((hasMesh) => hasMesh) ? [] : [this.shell(0)];
    const ranks = [...this.shown.shells].map((rank) => this.shell(rank));
    await Promise.all([...links, ...skin, ...ranks, slice]);
  }

  /** Called before each frame. */
  prepareFrame(camera: Vector3): void {
    this.slice.face(camera);
    if (this.paintIsDue) this.paint();
  }

  setPoints(points: BodyPoints): void {
    this.points?.dispose();
    this.points = new FeltPoints(points, this.stage.renderer.getPixelRatio());
    this.points.setLook(looks[this.theme]);
    this.root.add(this.points.group);
    this.apply();
  }

  update(snapshot: Snapshot): void {
    this.arm.move(snapshot.links);
    this.points?.update(snapshot, this.largestViscosity, this.shown.metresPerNewton);
    const [force, tool] = [snapshot.force, snapshot.tool];
    this.arrow.point(
      new Vector3(tool[0], tool[1], tool[2]),
      this.shown.drag && this.arm.group.visible
        ? new Vector3(force[0], force[1], force[2]).multiplyScalar(this.shown.metresPerNewton)
        : new Vector3(),
    );
    this.stage.draw();
  }

  get largestViscosity(): number {
    return largestViscosity(this.hello.field.records, this.feel.viscosity);
  }

  setFeel(feel: Feel): void {
    this.feel = feel;
    if (this.shown.colouring !== "viscosity") return;
    this.paintIsDue = true;
    this.stage.draw();
  }

  /** Shows what `shown` says now. */
  apply(): void {
    const { shown } = this;
    for (const rank of shown.shells) {
      this.shell(rank).catch((error: unknown) => this.onTrouble(error));
    }
    for (let rank = 1; rank <= this.hello.field.ranks; ++rank) {
      this.shells.show(rank, shown.shells.has(rank));
    }
    this.shells.show(0, shown.objects);
    this.shells.setOpacity(shown.opacity);
    this.objects.group.visible = shown.objects;
    this.slice.show(shown.slice);
    this.slice.cutAway(shown.cutAway);
    const armIsShown = shown.arm && !this.armGivesWay;
    this.arm.group.visible = armIsShown;
    this.arrow.group.visible &&= armIsShown;
    this.points?.showDots(shown.points);
    this.points?.showDrag(shown.drag);
    if (this.points) this.points.group.visible = armIsShown;
    this.paintIsDue = true;
    this.stage.draw();
  }

  /** The live arm gives way to recorded ones. */
  hideArm(hidden: boolean): void {
    this.armGivesWay = hidden;
    this.apply();
  }

  hide(object: number, hidden: boolean): void {
    this.hidden.set(object, hidden);
    this.objects.show(object, !hidden);
    this.paintIsDue = true;
    this.stage.draw();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    const look = looks[theme];
    this.objects.setLook(look);
    this.slice.setLook(look, theme);
    this.arm.setColour(look.arm);
    this.points?.setLook(look);
    this.arrow.setColour(look.drag);
    this.stage.draw();
  }

  /** Cuts elsewhere. While one cut is under way only the newest wish is remembered. */
  async cut(axis: Axis, where: number): Promise<void> {
    this.slice.axis = axis;
    this.slice.where = where;
    this.wantedSlice = { axis, where };
    if (this.sliceIsUnderWay) return;
    this.sliceIsUnderWay = true;
    try {
      while (this.wantedSlice && !this.disposed) {
        const wanted = this.wantedSlice;
        this.wantedSlice = null;
        const answer = readSlice(await this.connection.ask(sliceCommand(wanted.axis, wanted.where, 0)));
        if (answer.generation !== this.hello.generation || this.disposed) return;
        this.slice.place(answer);
        this.paintIsDue = true;
        this.stage.draw();
        this.onSlice();
      }
    } finally {
      this.sliceIsUnderWay = false;
    }
  }

  /** Meshes that another arm of this robot can be drawn with. */
  async meshesOfLinks(arm: Arm): Promise<void> {
    const { links } = this.hello.robot;
    await Promise.all(
      links.map(async (link, n) => {
        if (link.mesh) arm.add(readMesh(await this.connection.ask(meshCommand("link", n))));
      }),
    );
  }

  dispose(): void {
    this.disposed = true;
    this.root.removeFromParent();
    for (const part of [this.objects, this.shells, this.slice, this.arm, this.arrow]) part.dispose();
    this.points?.dispose();
    this.hidden.texture.dispose();
  }

  /** @return whether there is a mesh */
  private async loadMesh(kind: "object" | "link", index: number): Promise<boolean> {
    const answer = readMesh(await this.connection.ask(meshCommand(kind, index)));
    if (this.disposed || answer.triangles.length === 0) return false;
    if (kind === "link") this.arm.add(answer);
    else this.objects.add(answer);
    this.stage.draw();
    return true;
  }

  /** A shell is asked for once. */
  private shell(rank: number): Promise<void> {
    const asked = this.asked.get(rank) ?? this.loadShell(rank);
    this.asked.set(rank, asked);
    return asked;
  }

  private async loadShell(rank: number): Promise<void> {
    const messages = await this.connection.askForParts(shellCommand(rank), (message) => {
      if (message.type !== fromServer.shell) return true;
      const part = readShellPart(message);
      return part.part + 1 >= part.parts;
    });
    if (this.disposed) return;
    this.shells.add(rank, messages.map(readShellPart));
    this.apply();
  }

  private paint(): void {
    this.paintIsDue = false;
    const cut = this.slice.latest;
    if (!cut) return;
    const { records, ranks } = this.hello.field;
    const colours = sliceColours(records, this.feel.viscosity, ranks, this.shown.colouring, (object) =>
      this.hidden.has(object),
    );
    this.slice.paint(paintSlice(cut.codes, cut.width, colours, records), cut.width, cut.height);
  }
}
