// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Reads parsed JSON part by part: each part is what the reader expects, or says which one is not.
import { UnreadableMessage } from "./message";

export class Json {
  constructor(
    private readonly value: unknown,
    private readonly path = "message",
  ) {}

  get isNull(): boolean {
    return this.value === null || this.value === undefined;
  }

  at(key: string): Json {
    if (typeof this.value !== "object" || this.value === null) return this.fail("an object");
    return new Json((this.value as Record<string, unknown>)[key], `${this.path}.${key}`);
  }

  number(): number {
    return typeof this.value === "number" ? this.value : this.fail("a number");
  }
  numberOr<Other>(other: Other): number | Other {
    return typeof this.value === "number" ? this.value : other;
  }
  text(): string {
    return typeof this.value === "string" ? this.value : this.fail("a text");
  }
  textOr<Other>(other: Other): string | Other {
    return typeof this.value === "string" ? this.value : other;
  }
  flag(): boolean {
    return this.value === true;
  }

  list<Item>(read: (item: Json) => Item): Item[] {
    if (!Array.isArray(this.value)) return this.fail("a list");
    return this.value.map((item, n) => read(new Json(item, `${this.path}[${n}]`)));
  }
  /** An absent list reads as an empty one. */
  listOrNone<Item>(read: (item: Json) => Item): Item[] {
    return this.isNull ? [] : this.list(read);
  }
  numbers(length?: number): number[] {
    const numbers = this.list((item) => item.number());
    if (length !== undefined && numbers.length !== length) this.fail(`${length} numbers`);
    return numbers;
  }
  texts(): string[] {
    return this.listOrNone((item) => item.text());
  }
  entries(): [string, Json][] {
    if (this.isNull) return [];
    if (typeof this.value !== "object" || Array.isArray(this.value)) return this.fail("an object");
    return Object.entries(this.value as object).map(([key, value]) => [
      key,
      new Json(value, `${this.path}.${key}`),
    ]);
  }
  /** The part as it is, for what is only handed on. */
  raw(): unknown {
    return this.value;
  }

  private fail(expected: string): never {
    throw new UnreadableMessage(`${this.path} is not ${expected}`);
  }
}
