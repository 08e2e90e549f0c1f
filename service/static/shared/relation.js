// What a result is to the query, and why that is said.

import { html } from "../vendor/lit-html.js";
import { evidenceOf } from "./evidence.js";
import { RELATIONS } from "./words.js";

const PARTS = { query: "the query is a part of it", result: "a part of the query" };

export const relationName = ({ name, part }) => PARTS[part] ?? RELATIONS[name] ?? name;

export const evidence = (relation) => html`<ul>${evidenceOf(relation).map((sentence) => html`<li>${sentence}</li>`)}</ul>`;
