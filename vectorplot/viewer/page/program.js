// What the page and the widget have in common when they ask the program: the two answers that are no answer.

export class Refused extends Error {
  constructor(told) { super(told.cause); this.line = told.line; this.file = told.file; }
}
export class Superseded extends Error {}
