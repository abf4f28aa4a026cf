// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn, of which flock, and who.

import { useEffect, useMemo, useRef, useState } from 'preact/hooks';

import { colourOf } from './colours';
import { useNews } from './news';
import type { Run } from './run';
import { useParts, useValue, type Ghost } from './state';

const MOST_LISTED = 400; // animals
const AT_ONCE = 24; // entries of the list that are made in one go

type Switch = 'boxes' | 'ids' | 'bars' | 'grid';
const SWITCHES: [Switch, string, string][] = [
  ['boxes', 'boxes on the footage', 'b'],
  ['ids', 'ids on the footage', 'i'],
  ['bars', 'depth uncertainty (1 sd)', 'u'],
  ['grid', 'ground grid', 'g'],
];

function Animal({ run, animal }: { run: Run; animal: number }) {
  const { store } = run;
  const selected = useValue(store, (s) => s.selected === animal || s.second === animal);
  const hidden = useValue(store, (s) => s.hidden.has(animal));
  const dark = useValue(store, (s) => s.dark);
  const toggle = () => {
    const next = new Set(store.get().hidden);
    if (!next.delete(animal)) next.add(animal);
    store.set({ hidden: next });
  };
  return (
    <li class={(selected ? 'selected ' : '') + (hidden ? 'off' : '')}
      onMouseEnter={() => store.set({ hovered: animal })}
      onMouseLeave={() => store.set({ hovered: -1 })}>
      <button title="select; with shift: as the second"
        onClick={(e) => store.set(e.shiftKey ? { second: animal } : { selected: animal, second: -1 })}>
        <i class="dot" style={{ background: colourOf(animal, dark) }} />
        {run.animals[animal]}
      </button>
      <button class="eye" title="hide or show" aria-label="hide or show" onClick={toggle}>
        {hidden ? '○' : '●'}
      </button>
    </li>
  );
}

export function LookPanel({ run }: { run: Run }) {
  const { store, session } = run;
  const state = useParts(store, 'boxes', 'ids', 'bars', 'grid', 'trails', 'birdScale', 'ghost', 'solo',
    'hidden');
  const animals = useNews(run, () => run.animals);
  const solved = useNews(run, () => run.versions.after > 0);
  const [listed, setListed] = useState(AT_ONCE);
  const end = useRef<HTMLElement>(null);
  const shown = Math.min(animals.length, MOST_LISTED, listed);
  useEffect(() => {
    // As far as one sees: hundreds of entries hold up the pictures.
    if (!end.current || listed >= Math.min(animals.length, MOST_LISTED)) return undefined;
    const more = new IntersectionObserver((seen) => {
      if (seen.some((entry) => entry.isIntersecting)) setListed(listed + AT_ONCE);
    });
    more.observe(end.current);
    return () => more.disconnect();
  }, [listed, animals.length]);
  // Made once, so that they are not looked at again whenever the rest of the panel changes.
  const list = useMemo(() => Array.from({ length: shown }, (_, k) =>
    <Animal run={run} animal={k} key={k} />), [run, shown]);
  return (
    <div class="panel-body">
      <section>
        {SWITCHES.map(([name, words, key]) => (
          <label class="row">
            <input type="checkbox" checked={state[name]}
              onChange={(e) => store.set({ [name]: e.currentTarget.checked })} />
            {words} <kbd>{key}</kbd>
          </label>
        ))}
        <label class="row wide">trails
          <input type="range" min="0" max="200" value={state.trails}
            onInput={(e) => store.set({ trails: Number(e.currentTarget.value) })} />
          <output>{state.trails} frames</output>
        </label>
        <label class="row wide">birds
          <input type="range" min="0.3" max="4" step="0.1" value={state.birdScale}
            onInput={(e) => store.set({ birdScale: Number(e.currentTarget.value) })} />
          <output>{state.birdScale.toFixed(1)}×</output>
        </label>
        <label class="row wide"><span class="one-line">compare with</span>
          <select value={state.ghost}
            onChange={(e) => store.set({ ghost: e.currentTarget.value as Ghost })}>
            <option value="none">nothing</option>
            {session.has.truth && <option value="truth">the truth, in grey</option>}
            {solved && <option value="before">the flock before, in grey</option>}
          </select>
        </label>
      </section>
      {session.observability && <p class="muted">{session.observability}.</p>}
      <section class="animals">
        <header>
          <h3>{animals.length} animals</h3>
          <button class={state.solo ? 'on' : ''} title="only the selected ones (S)"
            onClick={() => store.set({ solo: !state.solo })}>solo</button>
          <button disabled={state.hidden.size === 0}
            onClick={() => store.set({ hidden: new Set() })}>show all</button>
        </header>
        <ul>{list}</ul>
        <i class="end" ref={end} />
        {MOST_LISTED < animals.length && <p class="muted">and {animals.length - MOST_LISTED} more: click them in the pictures.</p>}
      </section>
    </div>
  );
}
