// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Joins the server, the view and the panels. What happens goes through here; nothing is worked out
// here.
import { Vector3 } from "three";
import { readAddress } from "./app/address";
import { Charts } from "./app/charts";
import { Frame } from "./app/frame";
import { Keys } from "./app/keys";
import { session } from "./app/live_session";
import { Picking } from "./app/picking";
import { ReplayView } from "./app/replay_view";
import { button, iconButton, setPressed } from "./dom/controls";
import { byId, element } from "./dom/element";
import { applyTheme, currentTheme, keepTheme } from "./dom/theme";
import { Jog } from "./input/jog";
import { Leader } from "./input/leader";
import { MouseDrive } from "./input/mouse_drive";
import { DrivePanel } from "./panel/drive_panel";
import { FeelPanel } from "./panel/feel_panel";
import { Help } from "./panel/help";
import { LayersPanel } from "./panel/layers_panel";
import { Legend } from "./panel/legend";
import { Notices } from "./panel/notices";
import { ObjectsPanel } from "./panel/objects_panel";
import { PlayPanel } from "./panel/play_panel";
import { holdCommand, jointsCommand } from "./protocol/command";
import type { Hello, Vec3 } from "./protocol/hello";
import type { Axis } from "./protocol/shapes";
import { isSameMoment, type BodyPoints, type Snapshot } from "./protocol/snapshot";
import { uploadRecording } from "./scene/mesh_upload";
import { SceneEditor } from "./scene/scene_editor";
import { reasonLine } from "./text/reason";
import { DraftPreview } from "./view/draft_preview";
import { looks, type Theme } from "./view/look";
import { Stage, type ViewDirection } from "./view/stage";
import { ToolHandle } from "./view/tool_handle";
import { samplesOfWorkplaces, Workplace, type Shown } from "./view/workplace";

const asked = readAddress(location.search);
const canvas = byId<HTMLCanvasElement>("canvas");
const stage = new Stage(canvas);
stage.prepare(samplesOfWorkplaces());
const shown: Shown = {
  shells: new Set(),
  opacity: 0.22,
  slice: asked.slice !== "off",
  cutAway: asked.cutAway ?? true,
  colouring: "rank",
  objects: true,
  arm: true,
  points: true,
  drag: true,
  metresPerNewton: 0.05,
};
let workplace: Workplace | null = null;
let points: BodyPoints | null = null;
let theme: Theme = asked.theme ?? currentTheme();
let sliceIsPlaced = false; // where the address says, or at the tool, once it is known where that is
const felt = (): number => session.snapshot?.felt ?? 0;

// What is in the view beside the workplace.
const handle = new ToolHandle();
stage.scene.add(handle.group);
handle.group.visible = false;
const preview = new DraftPreview(stage, canvas, (xyz, turn) => editor.moved(xyz, turn));
stage.scene.add(preview.group);

// Panels.
const notices = new Notices();
const legend = new Legend();
const help = new Help();
const charts = new Charts();
const reason = element("output", { class: "reason", "data-reading": "reason", "aria-label": "What is felt most" });
const layers = new LayersPanel(shown, {
  apply: () => workplace?.apply(),
  cut: (axis, where) => void cut(axis, where),
  sliceAt: () => ({ axis: workplace?.slice.axis ?? 1, where: workplace?.slice.where ?? 0 }),
});
const objects = new ObjectsPanel({
  hide: (object, hidden) => workplace?.hide(object, hidden),
  choose: (object) => {
    workplace?.objects.choose(object);
    stage.draw();
  },
  lookAt: (object) => {
    const box = workplace?.objects.boxOf(object);
    if (box) stage.look("iso", box.expandByScalar(0.1));
  },
});
const drive = new DrivePanel({
  joints: (targets) => session.connection.send(jointsCommand(targets)),
  hold: () => hold(),
  setHalfAt: (newtons) => (mouse.halfAt = jog.halfAt = newtons),
});
const feel = new FeelPanel((change) => session.changeFeel(change));
let replayIsNew = false;
const replay = new ReplayView(session, stage, () => {
  replayIsNew = true;
  play.update();
});
const play: PlayPanel = new PlayPanel(replay.player, {
  open: (slot, name) => void replay.open(slot, name).catch((error: unknown) => session.fail(error)),
  close: (slot) => replay.close(slot),
  upload: (files) => void take([...files]),
  follow: () => replay.follow(),
});
const editor = new SceneEditor(
  session,
  preview,
  (sentence) => notices.say(sentence),
  () => frame.open("left", true),
);
const viewPage = element("div", {}, layers.root, objects.root);
const frame = new Frame(
  [
    ["View", viewPage],
    ["Edit scene", editor.panel.root],
  ],
  [
    ["Drive", drive.root],
    ["Feel", feel.root],
    ["Play", play.root],
  ],
  { theme: () => toggleTheme(), help: () => help.toggle(), strip: () => byId("strip").classList.toggle("folded") },
);

// Input.
const leader = new Leader(session, 0.25);
const jog = new Jog(leader, stage.camera, felt, (text) => drive.showGamepad(text));
const keys: Keys = new Keys(
  {
    "?": () => help.toggle(),
    t: () => toggleTheme(),
    m: () => measure(!picking.isMeasuring),
    h: (event) => (event.shiftKey ? objects.showAll() : objects.toggleChosen()),
    v: () => layers.toggleSlice(),
    c: () => layers.toggleCutAway(),
    g: () => layers.toggleAll(),
    x: () => !mouse.isDragging && layers.chooseAxis(0),
    y: () => !mouse.isDragging && layers.chooseAxis(1),
    z: () => !mouse.isDragging && layers.chooseAxis(2),
    "[": () => layers.step(-1),
    "]": () => layers.step(1),
    "{": () => layers.step(-10),
    "}": () => layers.step(10),
    "1": () => stage.look("iso"),
    "2": () => stage.look("front"),
    "3": () => stage.look("side"),
    "4": () => stage.look("top"),
    ArrowLeft: () => stage.turn(-0.08, 0),
    ArrowRight: () => stage.turn(0.08, 0),
    ArrowUp: () => stage.turn(0, 0.08),
    ArrowDown: () => stage.turn(0, -0.08),
    "+": () => stage.zoom(0.9),
    "=": () => stage.zoom(0.9),
    "-": () => stage.zoom(1 / 0.9),
    " ": () => replay.player.play(!replay.player.playing),
    ",": () => replay.player.seek(replay.player.time - 1 / 60),
    ".": () => replay.player.seek(replay.player.time + 1 / 60),
    Escape: () => {
      hold();
      measure(false);
      picking.close();
    },
  },
  (code, isDown, slow) => jog.key(code, isDown, slow),
  () => jog.releaseAll(),
);
const mouse: MouseDrive = new MouseDrive(canvas, stage, handle, leader, felt, () => keys.axisHeld());
const picking = new Picking(
  canvas,
  stage,
  session,
  () => workplace,
  () => mouse.isDragging || preview.isDragging,
  (object) => objects.choose(object),
);

const views: readonly [ViewDirection, string][] = [
  ["iso", "Corner (1)"],
  ["front", "Front (2)"],
  ["side", "Side (3)"],
  ["top", "Top (4)"],
];
const measureButton = iconButton("measure", "Measure between two points (M)", () => measure(!picking.isMeasuring), "icon");
setPressed(measureButton, false);
byId("overlay").append(
  element(
    "div",
    { class: "toolbar", role: "toolbar", "aria-label": "View" },
    ...views.map(([direction, label]) => button(label.split(" ")[0]!, () => stage.look(direction), { title: label, class: "quiet" })),
    measureButton,
  ),
  notices.root,
  picking.card.root,
  picking.label,
  element("div", { class: "bottom" }, reason, legend.root),
);
byId("strip").append(charts.chart.root);
document.body.append(help.root);
stage.onFrame(() => {
  workplace?.prepareFrame(stage.camera.position);
  handle.face(stage.camera, stage.camera.fov);
});
setTheme(theme);
if (!asked.panels) for (const side of ["left", "right"] as const) frame.open(side, false);

// What the server says.
session.on("state", (state) => {
  frame.showState(state);
  handle.group.visible = state === "open" && session.snapshot !== null;
  stage.draw();
});
session.on("trouble", (sentence) => notices.say(sentence, "bad"));
session.on("hello", (hello) => replaceWorkplace(hello));
session.on("points", (fresh) => {
  points = fresh;
  drawn = null;
  workplace?.setPoints(fresh);
});
session.on("feel", (fresh) => {
  workplace?.setFeel(fresh);
  layers.setFeel(fresh);
  feel.setFeel(fresh);
  if (workplace) legend.show(workplace.hello.field, fresh);
});
session.on("files", (files) => play.setFiles(files.recordings));
let fresh: Snapshot | null = null;
let drawn: Snapshot | null = null;
session.on("snapshot", (snapshot) => {
  fresh = snapshot;
  charts.add(snapshot);
});

function replaceWorkplace(hello: Hello): void {
  const old = workplace;
  const made = new Workplace(hello, stage, session.connection, shown, (error) => session.fail(error), () => undefined);
  workplace = made;
  made.setTheme(theme);
  made.slice.axis = old?.slice.axis ?? 1;
  made.slice.where = old?.slice.where ?? made.box.getCenter(new Vector3()).y;
  old?.dispose();
  drawn = null;
  if (points) made.setPoints(points);
  stage.setFocus(made.box);
  if (!old) {
    stage.look(asked.view ?? "iso");
    const ranks = Array.from({ length: hello.field.ranks }, (_, n) => n + 1);
    for (const rank of asked.shells === "all" ? ranks : asked.shells) {
      if (rank <= hello.field.ranks) shown.shells.add(rank);
    }
  }
  leader.mostAhead = 0.1 * made.box.getSize(new Vector3()).length();
  frame.showHello(hello);
  layers.setField(hello.field);
  objects.setField(hello.field);
  drive.setRobot(hello.robot);
  feel.setHello(hello);
  editor.setWorkplace(made, hello);
  replay.setWorkplace(made);
  charts.clear();
  for (const remark of hello.robot.remarks) notices.say(remark);
  performance.mark("hello");
  const loaded = made.load();
  stage.rest(loaded);
  loaded.then(() => finishLoading(made)).catch((error: unknown) => session.fail(error));
}

/** Says that all is drawn, for whoever takes a picture of the page. */
async function finishLoading(loaded: Workplace): Promise<void> {
  while (loaded === workplace && session.snapshot === null) await nextFrame();
  if (loaded !== workplace) return;
  performance.mark("all has come");
  loaded.apply();
  await nextFrame();
  await nextFrame();
  document.documentElement.dataset.ready = "true";
}

function nextFrame(): Promise<unknown> {
  return new Promise((resolve) => requestAnimationFrame(resolve));
}

async function cut(axis: Axis, where: number): Promise<void> {
  await workplace?.cut(axis, where).catch((error: unknown) => session.fail(error));
}

// Once a frame: what has come since the last one, and what the hands do.
let last = performance.now();
let panelsAt = 0;
let usualStep = 1 / 60; // [s]
function step(now: number): void {
  const seconds = (now - last) / 1000;
  last = now;
  usualStep += 0.2 * (Math.min(seconds, 0.5) - usualStep);
  jog.step(seconds);
  replay.player.step(seconds);
  const snapshot = fresh;
  fresh = null;
  if (snapshot) showSnapshot(snapshot, now);
  if (replayIsNew) showRecorded();
  requestAnimationFrame(step);
}

function showRecorded(): void {
  replayIsNew = false;
  const columns = replay.charts;
  if (!columns) return;
  charts.showRecorded(replay.player, columns);
  sayReason(replay.reasonLine);
}

function sayReason(line: string | null): void {
  reason.textContent = line ?? "nothing is felt";
  reason.classList.toggle("none", line === null);
}

function showSnapshot(snapshot: Snapshot, now: number): void {
  if (!workplace) return;
  const [x, y, z] = snapshot.tool;
  const tool = new Vector3(x, y, z);
  if (!sliceIsPlaced) {
    sliceIsPlaced = true;
    const slice = typeof asked.slice === "object" ? asked.slice : null;
    layers.place(slice?.axis ?? 1, slice?.where ?? tool.y);
  }
  if (!isSameMoment(snapshot, drawn)) workplace.update(snapshot);
  drawn = snapshot;
  handle.group.visible = !replay.hidesLiveArm;
  handle.move(tool, leader.isLeading ? leader.place : new Vector3().fromArray(snapshot.pulledTo));
  if (leader.isLeading) stage.draw();
  if (stage.isResting) return;
  // Where the processor draws, words and charts cost more than the view: they are drawn less often.
  const pause = 4000 * usualStep;
  if (now - panelsAt > pause) {
    panelsAt = now;
    drive.update(snapshot);
    const { field, robot } = workplace.hello;
    if (!replay.charts) sayReason(reasonLine(snapshot.reason, field, robot));
  }
  if (!replay.charts) charts.showLive(snapshot, now, stage.frameTimes.at(-1), pause);
}

function hold(): void {
  leader.end();
  session.connection.send(holdCommand());
}

function measure(on: boolean): void {
  picking.measure(on);
  setPressed(measureButton, on);
}

function setTheme(chosen: Theme): void {
  theme = chosen;
  applyTheme(theme);
  const look = looks[theme];
  workplace?.setTheme(theme);
  replay.setTheme(theme);
  handle.setColour(look.accent);
  preview.setColour(look.accent);
  picking.setColour(look.accent);
  charts.chart.setTheme();
  stage.draw();
}

function toggleTheme(): void {
  setTheme(theme === "dark" ? "light" : "dark");
  keepTheme(theme);
}

/** Files that were dropped or chosen: recordings are opened, meshes go into the scene. */
async function take(files: readonly File[]): Promise<void> {
  const isRecording = (file: File): boolean => /\.(csv|jsonl)$/i.test(file.name);
  for (const file of files.filter(isRecording)) {
    try {
      const name = await uploadRecording(session, file);
      await replay.open(replay.player.slots[0] ? 1 : 0, name);
    } catch (error) {
      session.fail(error);
    }
  }
  await editor.addMeshes(files.filter((file) => !isRecording(file)));
}

window.addEventListener("dragover", (event) => {
  event.preventDefault();
  document.body.classList.add("dropping");
});
window.addEventListener("dragleave", (event) => {
  if (event.relatedTarget === null) document.body.classList.remove("dropping");
});
window.addEventListener("drop", (event) => {
  event.preventDefault();
  document.body.classList.remove("dropping");
  if (event.dataTransfer) void take([...event.dataTransfer.files]);
});
document.addEventListener("visibilitychange", () => session.setRate(document.hidden ? 0 : 60));

// For scripts and a curious person: what the page last heard, how long its frames took [ms], where
// on the page a point is seen [px], the view as a picture, and which voxels the slice shows.
Object.assign(window, {
  vicinity: {
    hello: () => session.hello,
    snapshot: () => session.snapshot,
    frameTimes: () => [...stage.frameTimes],
    onPage: (point: Vec3) => stage.onPage(new Vector3(...point)),
    picture: () => stage.picture(),
    slice: () => `${workplace?.slice.latest?.axis} ${workplace?.slice.latest?.index}`,
  },
});

stage.fit();
session.connection.listen();
requestAnimationFrame(step);
