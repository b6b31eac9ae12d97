// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Joins the scene that is being edited to the server and to its preview in the view.
import { BufferAttribute, BufferGeometry, Matrix4, Quaternion, Vector3 } from "three";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { ScenePanel } from "../panel/scene_panel";
import { askForUnit } from "../panel/unit_dialog";
import { jsonCommand } from "../protocol/command";
import { readScene, type Hello } from "../protocol/hello";
import { Json } from "../protocol/json";
import { fromServer, toServer } from "../protocol/message";
import type { Session } from "../protocol/session";
import { bytesText, lengthUnits, metresPer, secondsText, type LengthUnit } from "../text/units";
import { DraftPreview, matrixOf } from "../view/draft_preview";
import type { Workplace } from "../view/workplace";
import { addMesh, nameOf, objectsOf, place, placementOf, standAlike, type Draft, type SceneObject } from "./draft";
import { uploadMesh } from "./mesh_upload";

function copyOf(draft: Draft): Draft {
  return { name: draft.name, scene: structuredClone(draft.scene) };
}

function unitOf(object: SceneObject): LengthUnit | null {
  return lengthUnits.find((unit) => unit === object.units) ?? null;
}

export class SceneEditor {
  readonly panel: ScenePanel;
  /** Triangles of uploads as they stand in their files, by the server's name. */
  private readonly uploads = new Map<string, Promise<BufferGeometry | null>>();
  private workplace: Workplace | null = null;
  /** Objects as they were built: what stands elsewhere is previewed. */
  private built = new Map<string, SceneObject>();

  constructor(
    private readonly session: Session,
    private readonly preview: DraftPreview,
    private readonly onNotice: (sentence: string) => void,
    private readonly onShow: () => void,
  ) {
    this.panel = new ScenePanel({
      build: (draft) => this.build(draft),
      saveScene: (name, draft) => this.save(name, draft),
      saveField: (name) => this.saveField(name),
      open: (name) => this.open(name),
      addMeshes: (files) => void this.addMeshes([...files]),
      preview: (draft, chosen, gizmo) => this.show(draft, chosen, gizmo),
      removed: (object) => preview.remove(object),
    });
    session.on("progress", (progress) => this.panel.showProgress(progress));
    session.on("files", (files) => this.panel.setFiles(files));
  }

  setWorkplace(workplace: Workplace, hello: Hello): void {
    this.workplace = workplace;
    this.panel.setCodings(hello.codings);
    this.built = new Map(
      hello.scene ? objectsOf(copyOf(hello.scene)).map((object) => [nameOf(object), object]) : [],
    );
    const isFirst = objectsOf(this.panel.draft).length === 0;
    if (hello.scene && isFirst) this.panel.setDraft(copyOf(hello.scene));
    else this.panel.refresh();
  }

  /** Files that were dropped on the page. */
  async addMeshes(files: readonly File[]): Promise<void> {
    for (const file of files) {
      try {
        const mesh = await uploadMesh(this.session, file);
        const unit = await askForUnit(file.name, mesh);
        if (unit === null) continue;
        this.uploads.set(mesh.mesh, readStl(file.name, file));
        const object = addMesh(this.panel.draft, file.name, mesh.mesh, unit);
        this.onShow();
        this.panel.choose(object);
      } catch (error) {
        this.session.fail(error);
      }
    }
  }

  /** The gizmo has moved the chosen object. */
  moved(xyz: Vector3, turn: Quaternion): void {
    const object = this.panel.chosenObject;
    if (!object) return;
    place(object, {
      ...placementOf(object),
      xyz: [xyz.x, xyz.y, xyz.z],
      quaternion: [turn.x, turn.y, turn.z, turn.w],
    });
    this.panel.moved();
    void this.showObject(object);
  }

  private show(draft: Draft, chosen: SceneObject | null, gizmo: "translate" | "rotate"): void {
    this.preview.hold(chosen ? placementOf(chosen) : null, gizmo);
    for (const object of objectsOf(draft)) void this.showObject(object);
  }

  private async showObject(object: SceneObject): Promise<void> {
    const was = this.built.get(nameOf(object));
    if (was && standAlike(was, object) && object !== this.panel.chosenObject) {
      this.preview.remove(object);
      return;
    }
    const upload = typeof object.mesh === "string" ? await this.geometryOf(object.mesh) : null;
    if (!objectsOf(this.panel.draft).includes(object)) return; // gone meanwhile
    const unit = unitOf(object);
    if (upload && unit) this.preview.show(object, upload, placementOf(object), metresPer(unit));
    else this.showBuilt(object);
  }

  /** An object of the field: its mesh was sent where it stood when it was built. */
  private showBuilt(object: SceneObject): void {
    const was = this.built.get(nameOf(object));
    const index = this.workplace?.hello.field.objects.findIndex(({ name }) => name === nameOf(object)) ?? -1;
    const mesh = this.workplace?.objects.meshOf(index);
    if (!was || !mesh) return;
    const key = this.preview.meshOf(object);
    const own = matrixOf(placementOf(was)).invert();
    const geometry = key?.geometry ?? mesh.geometry.clone().applyMatrix4(new Matrix4().copy(own));
    this.preview.show(object, geometry, placementOf(object), 1);
  }

  private geometryOf(mesh: string): Promise<BufferGeometry | null> {
    const name = mesh.split("/").at(-1) ?? mesh;
    const known = this.uploads.get(mesh);
    if (known) return known;
    const isUpload = this.session.files.meshes.some((upload) => upload === mesh || upload === name);
    const fetched = isUpload ? this.fetchStl(name) : Promise.resolve(null);
    if (isUpload) this.uploads.set(mesh, fetched);
    return fetched;
  }

  private async fetchStl(name: string): Promise<BufferGeometry | null> {
    const answer = await fetch(this.session.addressOf("file", name));
    return answer.ok ? readStl(name, await answer.blob()) : null;
  }

  private async build(draft: Draft): Promise<string> {
    const sent = copyOf(draft);
    const answer = await this.session.connection.ask(jsonCommand(toServer.build, { scene: sent.scene }));
    const report = new Json(answer.json(), "report").at("report");
    const voxels = ["boundary", "inner", "neighbour"].map((kind) => {
      return `${report.at(kind).numberOr(0).toLocaleString("en")} ${kind}`;
    });
    const remarks = report.at("remarks").texts();
    return [`Built in ${secondsText(report.at("seconds").numberOr(NaN))}: ${voxels.join(", ")} voxels.`, ...remarks].join(" ");
  }

  private async save(name: string, draft: Draft): Promise<string> {
    const plain = /\.ya?ml$/.test(name) ? name : `${name}.yaml`;
    const command = jsonCommand(toServer.saveScene, { name: plain, scene: draft.scene });
    const answer = new Json((await this.session.connection.ask(command)).json(), "DONE");
    return `Saved as ${answer.at("name").textOr(plain)}.`;
  }

  private async saveField(name: string): Promise<string> {
    const command = jsonCommand(toServer.saveField, { name });
    const answer = new Json((await this.session.connection.ask(command)).json(), "DONE");
    return `Saved as ${answer.at("name").textOr(name)}, ${bytesText(answer.at("bytes").numberOr(0))}.`;
  }

  private async open(name: string): Promise<Draft> {
    const message = await this.session.connection.ask(jsonCommand(toServer.openScene, { name }));
    const scene = message.type === fromServer.scene ? readScene(new Json(message.json(), "SCENE")) : null;
    if (!scene) throw new Error(`${name} holds no scene`);
    this.preview.clear();
    this.onNotice(`${name} is open; build it to feel it.`);
    return { name, scene: scene.scene };
  }
}

/** Triangles of an STL; null for another format, whose preview comes with the build. */
async function readStl(name: string, file: Blob): Promise<BufferGeometry | null> {
  if (!/\.stl$/i.test(name)) return null;
  try {
    const parsed = new STLLoader().parse(await file.arrayBuffer());
    const places = parsed.getAttribute("position");
    if (!(places instanceof BufferAttribute) || places.array.some((x) => !Number.isFinite(x))) return null;
    return parsed;
  } catch {
    return null; // the server says what is wrong with it
  }
}
