"use strict";
/**
 * Search in the index of tools/site/search_index.py.
 *
 * A section is found where each word that was typed begins one of its words. It ranks by how often they stand
 * there, more where they stand in its title, and more where the document is for somebody at a machine.
 */
const chaintrueSearch = (() => {
  // By how likely a reader of the site looks for it: a kind that is not listed counts 1.
  const WEIGHT = {"": 1.5, Tutorial: 1.6, "How to": 1.6};
  const CHANGES = /^changelog/;
  const TITLE = 6;
  const DOCUMENT = 3;
  const MOST = 30;

  // As the index has them; numbers are not in it.
  const typed = (text) => text.toLowerCase().match(/\p{L}[\p{L}\d]*(?:[-_][\p{L}\d]+)*/gu) || [];
  const begins = (title, word) => title.toLowerCase().split(/[^\p{L}\d]+/u).some((other) => other.startsWith(word));

  /** Section to how often a word that begins with `word` stands in it. */
  function times(index, word) {
    const found = new Map();
    for (const [other, places] of Object.entries(index.words)) {
      if (!other.startsWith(word)) continue;
      // Words that only begin so count less: who types "chain" looks for chains and not for chaintrue.
      const share = other === word || other === word + "s" ? 1 : 0.25;
      for (let k = 0; k < places.length; k += 2)
        found.set(places[k], (found.get(places[k]) || 0) + share * places[k + 1]);
    }
    return found;
  }

  function score(section, counts, words) {
    const [id, title, document, kind] = section;
    const sum = words.reduce((all, word, k) => {
      const named = (begins(title, word) ? TITLE : 0) + (begins(document, word) ? DOCUMENT : 0);
      return all + named + Math.log2(1 + counts[k]);
    }, 0);
    return sum * (CHANGES.test(id) ? 0.4 : WEIGHT[kind] || 1);
  }

  /** [{id, title, document, kind}], the best first; empty where nothing was typed. */
  function find(index, text) {
    const words = typed(text);
    if (words.length === 0) return [];
    const found = words.map((word) => times(index, word));
    return [...found[0].keys()]
      .filter((section) => found.every((places) => places.has(section)))
      .map((section) => ({section, score: score(index.sections[section], found.map((places) => places.get(section)), words)}))
      .sort((one, other) => other.score - one.score || one.section - other.section)
      .slice(0, MOST)
      .map(({section}) => {
        const [id, title, document, kind] = index.sections[section];
        return {id, title, document, kind};
      });
  }

  return {find, typed};
})();
