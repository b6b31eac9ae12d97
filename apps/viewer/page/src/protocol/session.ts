// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the page knows of the server at this moment, and who wants to hear when it changes.
import { emptyCommand, jsonCommand, rateCommand } from "./command";
import { Connection, type ConnectionState } from "./connection";
import { readFeel, readFiles, readHello, type Feel, type Files, type Hello } from "./hello";
import { Json } from "./json";
import { fromServer, toServer } from "./message";
import { readPoints, readSnapshot, type BodyPoints, type Snapshot } from "./snapshot";

export interface Progress {
  stage: string;
  /** 0..1 */
  done: number;
}

interface Events {
  state: ConnectionState;
  trouble: string;
  hello: Hello;
  points: BodyPoints;
  snapshot: Snapshot;
  feel: Feel;
  files: Files;
  progress: Progress;
}

type Listener<Name extends keyof Events> = (event: Events[Name]) => void;

export class Session {
  hello: Hello | null = null;
  feel: Feel | null = null;
  files: Files = { scenes: [], meshes: [], recordings: [], fields: [] };
  snapshot: Snapshot | null = null;
  readonly connection: Connection;

  private readonly listeners: { [Name in keyof Events]?: Listener<Name>[] } = {};

  constructor(
    address: string,
    private readonly token: string | null,
  ) {
    this.connection = new Connection(
      token === null ? address : `${address}?token=${encodeURIComponent(token)}`,
      (state) => this.tell("state", state),
      (sentence) => this.tell("trouble", sentence),
    );
    this.listen();
  }

  on<Name extends keyof Events>(name: Name, listener: Listener<Name>): void {
    (this.listeners[name] ??= []).push(listener as never);
  }

  /** Changes how the arm feels; what is left out stays. Trouble is told. */
  changeFeel(change: Record<string, unknown>): void {
    this.run(jsonCommand(toServer.feel, change));
  }

  list(): void {
    this.connection.send(emptyCommand(toServer.list));
  }

  setRate(perSecond: number): void {
    this.run(rateCommand(perSecond));
  }

  /** A command whose answer says no more than that it is done. */
  run(command: ArrayBuffer): void {
    this.connection.ask(command).catch((error: unknown) => this.fail(error));
  }

  fail(error: unknown): void {
    this.tell("trouble", error instanceof Error ? error.message : String(error));
  }

  /** Address of a file or an upload on the server. */
  addressOf(path: "upload" | "file", name: string): string {
    const token = this.token === null ? "" : `&token=${encodeURIComponent(this.token)}`;
    return `./${path}?name=${encodeURIComponent(name)}${token}`;
  }

  private listen(): void {
    const { connection } = this;
    connection.on(fromServer.hello, (message) => {
      this.hello = readHello(new Json(message.json(), "HELLO"));
      this.feel = this.hello.feel;
      this.files = this.hello.files;
      this.tell("hello", this.hello);
      this.tell("feel", this.feel);
      this.tell("files", this.files);
    });
    connection.on(fromServer.points, (message) => this.tell("points", readPoints(message)));
    connection.on(fromServer.snapshot, (message) => {
      this.snapshot = readSnapshot(message);
      this.tell("snapshot", this.snapshot);
    });
    connection.on(fromServer.feel, (message) => {
      this.feel = readFeel(new Json(message.json(), "FEEL"));
      this.tell("feel", this.feel);
    });
    connection.on(fromServer.files, (message) => {
      this.files = readFiles(new Json(message.json(), "FILES"));
      this.tell("files", this.files);
    });
    connection.on(fromServer.progress, (message) => {
      const json = new Json(message.json(), "PROGRESS");
      this.tell("progress", { stage: json.at("stage").textOr(""), done: json.at("done").numberOr(0) });
    });
  }

  private tell<Name extends keyof Events>(name: Name, event: Events[Name]): void {
    for (const listener of this.listeners[name] ?? []) (listener as Listener<Name>)(event);
  }
}
