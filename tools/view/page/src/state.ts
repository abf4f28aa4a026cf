// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the person has chosen, in one place. Parts of the page read it, change it by set(), and are
// told of every change.

import { useEffect, useState } from 'preact/hooks';

export type Mode = 'look' | 'solve' | 'mend' | 'sketch' | 'steer';
export type ViewName = 'orbit' | 'camera' | 'top' | 'side' | 'follow';
export type Table = 'before' | 'after';
export type Ghost = 'none' | 'before' | 'truth';

export interface State {
  mode: Mode;
  frame: number;
  playing: boolean;
  speed: number;
  loop: boolean;
  selected: number; // place in the list of animals; -1: none
  second: number; // the other one of an edit
  hovered: number;
  hidden: ReadonlySet<number>;
  solo: boolean; // only the selected ones
  view: ViewName;
  table: Table;
  ghost: Ghost;
  boxes: boolean;
  ids: boolean;
  trails: number; // frames
  bars: boolean;
  grid: boolean;
  birdScale: number;
  panel: boolean;
  help: boolean;
  gone: boolean;
  message: string; // what went wrong last; empty: nothing
  reading: string; // what the server still reads; empty: nothing
  faults: string[]; // of the files that it read
  dark: boolean;
}

type Listener = (state: State, before: State) => void;

export class Store {
  private listeners = new Set<Listener>();
  constructor(private current: State) {}

  get(): State {
    return this.current;
  }
  set(change: Partial<State>): void {
    const before = this.current;
    let differs = false;
    for (const key of Object.keys(change) as (keyof State)[]) {
      differs ||= before[key] !== change[key];
    }
    if (!differs) return;
    this.current = { ...before, ...change };
    for (const listener of this.listeners) listener(this.current, before);
  }
  watch(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
  fail(error: unknown): void {
    this.set({ message: error instanceof Error ? error.message : String(error) });
  }
}

// One value of the state in a component, drawn again when it changes.
export function useValue<T>(store: Store, pick: (state: State) => T): T {
  const [value, setValue] = useState(() => pick(store.get()));
  useEffect(() => {
    let last = pick(store.get());
    setValue(() => last);
    return store.watch((state) => {
      const next = pick(state);
      if (next === last) return;
      last = next;
      setValue(() => next);
    });
  }, [store]);
  return value;
}

// The state in a component that is drawn again when one of these parts changes.
export function useParts<Part extends keyof State>(store: Store, ...parts: Part[]): Pick<State, Part> {
  const [state, setState] = useState(() => store.get());
  useEffect(() => {
    setState(store.get());
    return store.watch((now, before) => {
      if (parts.some((part) => now[part] !== before[part])) setState(now);
    });
  }, [store]);
  return state;
}

export function isShown(state: State, animal: number): boolean {
  if (state.solo && state.selected >= 0) {
    return animal === state.selected || animal === state.second;
  }
  return !state.hidden.has(animal);
}
