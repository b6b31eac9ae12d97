// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The WebSocket: commands find their answers by id, everything else goes to whoever listens for it.
// Where the server goes away, it is asked again, ever more slowly.
import { withId } from "./command";
import { Json } from "./json";
import { fromServer, Message } from "./message";

/** What the server could not do, in its own words. */
export class Refusal extends Error {}

export type ConnectionState = "connecting" | "open" | "lost";

/** The server lets 64 commands of a page wait; what is asked beyond these is asked later. */
const mostWaiting = 32;

interface Waiting {
  answer: (message: Message) => void;
  refuse: (why: Error) => void;
  /** A shell comes in several parts: all but the last leave the command waiting. */
  isLast: (message: Message) => boolean;
}

/** Told to everybody, even where one page's command was the cause. */
const announcements: ReadonlySet<number> = new Set([
  fromServer.hello,
  fromServer.points,
  fromServer.snapshot,
  fromServer.feel,
  fromServer.progress,
  fromServer.files,
]);

function sentenceOf(message: Message): string {
  const said = new Json(message.json());
  return said.at("sentence").textOr("the server could not do that");
}

export class Connection {
  private socket: WebSocket | null = null;
  private readonly waiting = new Map<number, Waiting>();
  private backlog: { command: ArrayBuffer; waiting: Waiting }[] = [];
  private readonly listeners = new Map<number, ((message: Message) => void)[]>();
  private lastId = 0;
  private pause = 500; // [ms]
  private state: ConnectionState = "connecting";
  private held: unknown[] | null = []; // what has come before anybody listens

  constructor(
    private readonly address: string,
    private readonly onState: (state: ConnectionState) => void,
    private readonly onTrouble: (sentence: string) => void,
  ) {}

  /** Connects. Nothing is told before `listen`. */
  open(): void {
    this.enter("connecting");
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.addEventListener("open", () => {
      this.pause = 500;
      this.enter("open");
    });
    socket.addEventListener("message", (event: MessageEvent<unknown>) => this.receive(event.data));
    socket.addEventListener("close", this.lose);
  }

  /** For good: nobody will listen. */
  end(): void {
    this.held = [];
    this.socket?.removeEventListener("close", this.lose);
    this.socket?.close();
  }

  /** From now on, and first of all what has come before: once all listeners are in place. */
  listen(): void {
    const held = this.held ?? [];
    this.held = null;
    this.onState(this.state);
    for (const data of held) this.receive(data);
  }

  /** Calls `listen` for every message of a type that answers no command. */
  on(type: number, listen: (message: Message) => void): void {
    this.listeners.set(type, [...(this.listeners.get(type) ?? []), listen]);
  }

  /** Sends what has no answer; says nothing where the server is away. */
  send(command: ArrayBuffer): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(command);
  }

  /** Sends a command and waits for its answer. Errors: Refusal, in the server's words. */
  ask(command: ArrayBuffer): Promise<Message> {
    return new Promise((answer, refuse) => {
      this.begin(command, { answer, refuse, isLast: () => true });
    });
  }

  /** For answers in parts: all messages, once the last has come. */
  askForParts(command: ArrayBuffer, isLast: (message: Message) => boolean): Promise<Message[]> {
    return new Promise((answer, refuse) => {
      const parts: Message[] = [];
      this.begin(command, {
        answer: (part) => {
          parts.push(part);
          if (isLast(part)) answer(parts);
        },
        refuse,
        isLast,
      });
    });
  }

  private begin(command: ArrayBuffer, waiting: Waiting): void {
    if (this.socket?.readyState !== WebSocket.OPEN) {
      waiting.refuse(new Refusal("the server is not there"));
      return;
    }
    this.backlog.push({ command, waiting });
    this.sendBacklog();
  }

  private sendBacklog(): void {
    while (this.waiting.size < mostWaiting) {
      const next = this.backlog.shift();
      if (!next) return;
      this.lastId = (this.lastId % 0xffffffff) + 1;
      this.waiting.set(this.lastId, next.waiting);
      this.socket?.send(withId(next.command, this.lastId));
    }
  }

  private enter(state: ConnectionState): void {
    this.state = state;
    if (!this.held) this.onState(state);
  }

  private receive(data: unknown): void {
    if (this.held) {
      this.held.push(data);
      return;
    }
    try {
      if (!(data instanceof ArrayBuffer)) throw new Error("the server sent a text message");
      this.deliver(new Message(data));
    } catch (error) {
      this.onTrouble(error instanceof Error ? error.message : String(error));
    }
  }

  private deliver(message: Message): void {
    const isAnswer = message.id !== 0 && !announcements.has(message.type);
    const waiting = isAnswer ? this.waiting.get(message.id) : undefined;
    if (waiting) {
      const refused = message.type === fromServer.error;
      if (refused || waiting.isLast(message)) this.waiting.delete(message.id);
      this.sendBacklog();
      if (refused) waiting.refuse(new Refusal(sentenceOf(message)));
      else waiting.answer(message);
      return;
    }
    if (message.type === fromServer.error) this.onTrouble(sentenceOf(message));
    for (const listen of this.listeners.get(message.type) ?? []) listen(message);
  }

  private readonly lose = (): void => {
    this.enter("lost");
    const unanswered = [...this.waiting.values(), ...this.backlog.map(({ waiting }) => waiting)];
    this.waiting.clear();
    this.backlog = [];
    for (const { refuse } of unanswered) refuse(new Refusal("the server went away"));
    setTimeout(() => this.open(), this.pause);
    this.pause = Math.min(8000, 1.6 * this.pause);
  };
}
