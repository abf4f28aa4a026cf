// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parameters of a scene's models on sliders, pace, wind, and saving the scene as steered.

import { useEffect, useRef, useState } from 'preact/hooks';

import { post } from './api';
import { addKnob, makeGui } from './knobs';
import { useValue, type Store } from './state';
import { steer } from './steer';
import type { SceneSession } from './types';

export function SteerPanel({ session, store }: { session: SceneSession; store: Store }) {
  const host = useRef<HTMLDivElement>(null);
  const [name, setName] = useState(`${session.name}_steered.toml`);
  const [saved, setSaved] = useState('');
  const sketching = useValue(store, (s) => s.mode === 'sketch');
  const trails = useValue(store, (s) => s.trails);
  const scale = useValue(store, (s) => s.birdScale);
  useEffect(() => {
    if (!host.current) return;
    const gui = makeGui(host.current);
    for (const species of session.species) {
      const folder = gui.addFolder(`${species.name}: ${species.model}`);
      folder.domElement.title = species.help;
      for (const p of species.parameters) {
        const value = p.choices.length > 0 ? p.choices[p.value] : p.value;
        addKnob(folder, { ...p, value }, (turned) =>
          steer(store, { do: 'parameter', species: species.name, name: p.name, value: turned }));
      }
    }
    const wind = gui.addFolder('wind [m/s]').close();
    const velocity = { x: session.wind[0], y: session.wind[1], z: session.wind[2] };
    for (const axis of ['x', 'y', 'z'] as const) {
      wind.add(velocity, axis, -15, 15, 0.1).onChange(() =>
        steer(store, { do: 'wind', velocity: [velocity.x, velocity.y, velocity.z] }));
    }
    return () => gui.destroy();
  }, []);
  const save = async () => {
    try {
      setSaved((await post<{ file: string }>('api/save', { name })).file);
    } catch (error) {
      setSaved('');
      store.fail(error);
    }
  };
  return (
    <div class="panel-body steer">
      {sketching ? (
        <p class="hint">Drag over the scene: {session.paths.length > 0
          ? 'the line becomes the curve that guides the animals, and the scene starts anew.'
          : 'a goal flies along the line, and everybody follows it.'}</p>
      ) : (
        <p class="muted">Click: attract everybody there. Drag a goal or a predator. Turn with the mouse.</p>
      )}
      <div ref={host} class="knobs" />
      <section>
        <label class="row wide">trails
          <input type="range" min="0" max="40" value={trails}
            onInput={(e) => store.set({ trails: Number(e.currentTarget.value) })} />
          <output>{trails} looks</output>
        </label>
        <label class="row wide">animals
          <input type="range" min="0.3" max="4" step="0.1" value={scale}
            onInput={(e) => store.set({ birdScale: Number(e.currentTarget.value) })} />
          <output>{scale.toFixed(1)}×</output>
        </label>
      </section>
      <section>
        <h3>Save as a scene</h3>
        <div class="line">
          <input class="text" aria-label="file name" value={name} onInput={(e) => setName(e.currentTarget.value)} />
          <button onClick={() => void save()}>save</button>
        </div>
        {saved && <p class="muted">Saved: <code>{saved}</code></p>}
      </section>
    </div>
  );
}
