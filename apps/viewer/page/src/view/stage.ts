// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The room that everything stands in: camera, light, orbiting. It draws only when something has
// changed, so that a page that shows a resting arm costs nothing.
import {
  Box3,
  PerspectiveCamera,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

// No frame for so long: nothing has moved, and the pause is no frame's time.
const restAfter_ms = 1000;
// What comes within this time is drawn at once, and not piece by piece: where the processor draws,
// each frame that shows half of it delays the other half.
const longestRest_ms = 1500;

export type ViewDirection = "iso" | "front" | "side" | "top";

const directions: Record<ViewDirection, Vector3> = {
  iso: new Vector3(-0.42, -1, 0.5),
  front: new Vector3(0, -1, 0),
  side: new Vector3(1, 0, 0),
  top: new Vector3(0, -0.001, 1), // not straight down: up would have no direction
};

/** With smooth edges where a graphics card draws them; for a processor they cost more than they show. */
function contextOf(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  const context =
    canvas.getContext("webgl2", { alpha: true, antialias: true, failIfMajorPerformanceCaveat: true }) ??
    canvas.getContext("webgl2", { alpha: true, antialias: false });
  if (!context) throw new Error("it has no WebGL 2; turn graphics acceleration on, or try another one");
  return context;
}

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(38, 1, 0.01, 200);
  readonly renderer: WebGLRenderer;
  readonly orbit: OrbitControls;

  /** Time between one frame and the next, while frames follow each other [ms]. */
  readonly frameTimes: number[] = [];

  private wanted = false;
  private rests = true; // until there is something to draw
  private lastFrame = 0;
  private focus = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  private readonly beforeFrame: (() => void)[] = [];
  private prepareHalf: ((half: 0 | 1) => void) | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, context: contextOf(canvas), alpha: true });
    // Asking how each shader compiled waits for it; that they do is tested before anybody opens the page.
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV;
    this.renderer.setClearAlpha(0);

    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableDamping = false; // what the hand does is what is seen, and frames are repeatable
    this.orbit.addEventListener("change", () => this.draw());
    this.look("iso");

    new ResizeObserver(() => this.fit()).observe(canvas);
  }

  /** Begins to make the shaders of things: it takes a while, in which other things can be done. */
  prepare(things: Object3D): void {
    this.renderer.compile(things, this.camera);
  }

  /** What is shown is about to come: nothing else should take time now. */
  get isResting(): boolean {
    return this.rests;
  }

  /** Draws nothing until all has come, or for a moment at most. */
  rest(until: Promise<unknown>): void {
    this.rests = true;
    const goOn = (): void => {
      this.rests = false;
      this.draw();
    };
    until.then(goOn, goOn);
    setTimeout(goOn, longestRest_ms);
  }

  /** Something has changed: draw a frame when the browser next shows one. */
  draw(): void {
    if (this.wanted || this.rests) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.render();
      this.time();
    });
  }

  /** The view as it is now, as the address of a PNG. */
  picture(): string {
    this.render(); // what was drawn before is gone once it has been shown
    return this.canvas.toDataURL("image/png");
  }

  /** Called before each frame, for what depends on the camera. */
  onFrame(prepare: () => void): void {
    this.beforeFrame.push(prepare);
  }

  /** What `look` brings into view. */
  setFocus(box: Box3): void {
    this.focus = box.clone();
    const size = box.getSize(new Vector3()).length();
    this.camera.near = size / 2000;
    this.camera.far = size * 20;
    this.camera.updateProjectionMatrix();
  }

  /** Looks at the focus from a direction, from so far that all of it is seen. */
  look(from: ViewDirection, box: Box3 = this.focus): void {
    const centre = box.getCenter(new Vector3());
    const radius = Math.max(box.getSize(new Vector3()).length() / 2, 1e-3);
    const half = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.78 * radius) / Math.sin(Math.atan(Math.tan(half) * narrow));
    this.orbit.target.copy(centre);
    this.camera.position.copy(directions[from]).normalize().multiplyScalar(distance).add(centre);
    this.orbit.update();
    this.draw();
  }

  /** Turns the view by angles [rad], as the arrow keys do. */
  turn(azimuth: number, elevation: number): void {
    const arm = this.camera.position.clone().sub(this.orbit.target);
    const length = arm.length();
    const around = Math.atan2(arm.y, arm.x) + azimuth;
    const up = Math.min(1.55, Math.max(-1.55, Math.asin(arm.z / length) + elevation));
    arm.set(Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up));
    this.camera.position.copy(this.orbit.target).addScaledVector(arm, length);
    this.orbit.update();
    this.draw();
  }

  /** Comes nearer (factor below one) or goes away. */
  zoom(factor: number): void {
    const arm = this.camera.position.clone().sub(this.orbit.target).multiplyScalar(factor);
    this.camera.position.copy(this.orbit.target).add(arm);
    this.orbit.update();
    this.draw();
  }

  /** Shows two halves side by side, through one camera; null: one picture again. */
  setHalves(prepare: ((half: 0 | 1) => void) | null): void {
    if ((this.prepareHalf === null) === (prepare === null)) return;
    this.prepareHalf = prepare;
    this.fit();
  }

  /** A pointer's place in the picture that it is over as three.js wants it, -1..1. */
  pointerAt(event: { clientX: number; clientY: number }): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    const width = this.prepareHalf ? box.width / 2 : box.width;
    const across = event.clientX - box.left;
    const left = this.prepareHalf && across >= width ? width : 0;
    return {
      x: (2 * (across - left)) / width - 1,
      y: 1 - (2 * (event.clientY - box.top)) / box.height,
    };
  }

  private render(): void {
    for (const prepare of this.beforeFrame) prepare();
    if (this.prepareHalf) this.renderHalves(this.prepareHalf);
    else this.renderer.render(this.scene, this.camera);
  }

  private time(): void {
    const now = performance.now();
    if (now - this.lastFrame < restAfter_ms) this.frameTimes.push(now - this.lastFrame);
    if (this.frameTimes.length > 240) this.frameTimes.shift();
    this.lastFrame = now;
  }

  /** Where on the page a point of the workplace is seen [px]; in the left half where there are two. */
  onPage(point: Vector3): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    const width = this.prepareHalf ? box.width / 2 : box.width;
    const at = point.clone().project(this.camera);
    return { x: box.left + (width * (1 + at.x)) / 2, y: box.top + (box.height * (1 - at.y)) / 2 };
  }

  private renderHalves(prepare: (half: 0 | 1) => void): void {
    const width = Math.max(1, this.canvas.clientWidth) / 2;
    const height = Math.max(1, this.canvas.clientHeight);
    this.renderer.setScissorTest(true);
    for (const half of [0, 1] as const) {
      prepare(half);
      this.renderer.setViewport(half * width, 0, width, height);
      this.renderer.setScissor(half * width, 0, width, height);
      this.renderer.render(this.scene, this.camera);
    }
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(0, 0, 2 * width, height);
  }

  /** Draws in the canvas's size on the page from now on. */
  fit(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    const pixelRatio = Math.min(window.devicePixelRatio, 2);
    const before = this.renderer.getSize(new Vector2());
    // A size that is set means new memory to draw into, even where it is the old size.
    if (before.x !== width || before.y !== height || this.renderer.getPixelRatio() !== pixelRatio) {
      this.renderer.setDrawingBufferSize(width, height, pixelRatio);
    }
    this.camera.aspect = (this.prepareHalf ? width / 2 : width) / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
