// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Corrections by clicks: each is a line of the corrections file, sent to the server.

import { post } from './api';
import type { Run } from './run';
import type { Edits, Versions } from './types';

export type Tool = 'none' | 'pin' | 'add';

interface Answer {
  edits: Edits;
  versions: Versions;
}

export class Mending {
  tool: Tool = 'none';
  at = -1; // the suspect jumped to last

  constructor(private run: Run) {}

  private async send(path: string, body: unknown = {}): Promise<void> {
    try {
      const answer = await post<Answer>(path, body);
      this.run.setEdits(answer.edits);
      this.run.setVersions(answer.versions);
      this.run.store.set({ message: '' });
      await this.run.askSuspects();
    } catch (error) {
      this.run.store.fail(error);
    }
  }

  private id(animal: number): string {
    return this.run.animals[animal] ?? '';
  }
  private need(count: number, words: string): boolean {
    const { selected, second } = this.run.store.get();
    const has = (selected >= 0 ? 1 : 0) + (second >= 0 ? 1 : 0);
    if (has < count) this.run.store.set({ message: words });
    return has >= count;
  }

  line(line: string): Promise<void> {
    return this.send('api/edit', { line });
  }
  undo(): Promise<void> {
    return this.send('api/undo');
  }
  redo(): Promise<void> {
    return this.send('api/redo');
  }
  async swap(): Promise<void> {
    const { selected, second, frame } = this.run.store.get();
    if (!this.need(2, 'Swap: click one animal, and the other with shift.')) return;
    await this.line(`swap ${this.id(selected)} ${this.id(second)} ${frame}`);
  }
  async join(): Promise<void> {
    const { selected, second } = this.run.store.get();
    if (!this.need(2, 'Join: click one track, and with shift the one that goes on as it.')) return;
    await this.line(`join ${this.id(selected)} ${this.id(second)}`);
    this.run.store.set({ second: -1 });
  }
  async split(): Promise<void> {
    const { selected, frame } = this.run.store.get();
    if (this.need(1, 'Split: click an animal first.')) {
      await this.line(`split ${this.id(selected)} ${frame}`);
    }
  }
  async remove(): Promise<void> {
    const { selected } = this.run.store.get();
    if (!this.need(1, 'Delete: click an animal first.')) return;
    await this.line(`delete ${this.id(selected)}`);
    this.run.store.set({ selected: -1, second: -1 });
  }
  choose(tool: Tool): void {
    if (tool === 'pin' && this.tool !== tool && !this.need(1, 'Pin: click an animal first.')) return;
    this.tool = this.tool === tool ? 'none' : tool;
    this.run.setEdits(this.run.edits);
  }
  drop(): void {
    if (this.tool !== 'none') this.choose(this.tool);
  }
  // A click on the footage while a tool is chosen; false when there is none.
  click(x: number, y: number): boolean {
    const { selected, frame } = this.run.store.get();
    const at = `${frame} ${x.toFixed(2)} ${y.toFixed(2)}`;
    if (this.tool === 'none') return false;
    if (this.tool === 'pin') void this.line(`pin ${this.id(selected)} ${at}`);
    else void this.line(`add ${at}`);
    this.tool = 'none';
    return true;
  }

  // To the next suspect in order of doubt, a moment before it.
  jump(by: number): void {
    const { suspects, store, clock } = this.run;
    if (suspects.length === 0) return;
    this.at = (this.at + by + suspects.length) % suspects.length;
    const s = suspects[this.at];
    store.set({ playing: false, selected: this.run.indexOf(s.id),
      second: s.other ? this.run.indexOf(s.other) : -1 });
    clock.go(s.frame);
    this.run.setEdits(this.run.edits);
  }
}
