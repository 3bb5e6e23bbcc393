// What is seen while it is recorded: the states of the page, at most so many a second; where nothing changes there is no frame.

export const FRAME_MS = 40, MOST_FRAMES = 1500;

export class Recording {
  constructor(state) { this.states = [state]; this.slot = -1; }
  get full() { return this.states.length >= MOST_FRAMES; }

  // A state at a time in milliseconds: of those within one frame the last one stays.
  see(state, now) {
    const slot = Math.floor(now / FRAME_MS);
    if (slot === this.slot) this.states.pop();
    this.states.push(state);
    this.slot = slot;
  }

  // The first state, and of each other one what is new in it.
  frames() {
    return this.states.map((state, k) => Object.fromEntries(Object.entries(state).filter(
      ([field, value]) => !k || JSON.stringify(value) !== JSON.stringify(this.states[k - 1][field]))));
  }
}
