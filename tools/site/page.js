"use strict";
(() => {
  const articles = [...document.querySelectorAll("article")];
  const links = [...document.querySelectorAll("#contents a")];
  const words = document.getElementById("words");
  const hits = document.getElementById("hits");
  const contents = document.getElementById("contents");
  const index = JSON.parse(document.getElementById("search-index").textContent);
  const narrow = window.matchMedia("(max-width: 760px)");

  // One document at a time; an address names a document, or a heading in it, or "search=" and words.
  function show() {
    const address = decodeURIComponent(location.hash.slice(1));
    if (address.startsWith("search=")) {
      words.value = address.slice("search=".length).replace(/\+/g, " ");
      search();
    }
    const goal = document.getElementById(address) || articles[0];
    const article = goal.closest("article") || articles[0];
    for (const other of articles) other.classList.toggle("shown", other === article);
    for (const link of links) {
      if (link.hash === "#" + article.id) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    document.title = article.dataset.title + " - chaintrue";
    if (narrow.matches) contents.open = false;
    mark(address.startsWith("search=") ? null : article);
    if (goal !== article) goal.scrollIntoView();
    else if (!address.startsWith("search=")) window.scrollTo(0, 0);
  }

  // The words that were looked for, in the document that was chosen: where none stands whole, what begins so.
  function mark(article) {
    for (const old of document.querySelectorAll("mark")) old.replaceWith(...old.childNodes);
    for (const other of articles) other.normalize();
    const wanted = chaintrueSearch.typed(words.value).filter((word) => word.length > 1);
    if (article === null || wanted.length === 0) return;
    if (!markAll(article, wanted, "s?(?![\\p{L}\\d])")) markAll(article, wanted, "");
  }

  function markAll(article, wanted, end) {
    const pattern = new RegExp(`(?<![\\p{L}\\d])((?:${wanted.join("|")})${end})`, "giu");
    const walker = document.createTreeWalker(article, NodeFilter.SHOW_TEXT);
    const texts = [];
    while (walker.nextNode()) texts.push(walker.currentNode);
    let marked = 0;
    for (const text of texts) {
      const parts = text.data.split(pattern);
      if (parts.length === 1) continue;
      marked += 1;
      text.replaceWith(...parts.map((part, k) => {
        if (k % 2 === 0) return part;
        const found = document.createElement("mark");
        found.textContent = part;
        return found;
      }));
    }
    return marked > 0;
  }

  // What stands around the first of the words, in the section.
  function snippet(id, word) {
    const start = document.getElementById(id);
    let text = "";
    const first = start.matches("article") ? start.firstElementChild.nextElementSibling : start.nextElementSibling;
    for (let part = first; part && !/^H[1-6]$/.test(part.tagName); part = part.nextElementSibling)
      text += part.textContent + " ";
    const flat = text.replace(/\s+/g, " ");
    const at = Math.max(0, flat.toLowerCase().indexOf(word) - 40);
    return (at > 0 ? "..." : "") + flat.slice(at, at + 130);
  }

  function search() {
    const wanted = chaintrueSearch.typed(words.value);
    hits.hidden = wanted.length === 0;
    contents.hidden = wanted.length > 0;
    hits.textContent = "";
    for (const hit of chaintrueSearch.find(index, words.value)) {
      const line = document.createElement("li");
      const link = document.createElement("a");
      link.href = "#" + hit.id;
      link.textContent = hit.title === hit.document ? hit.title : `${hit.document}: ${hit.title}`;
      const where = document.createElement("small");
      where.textContent = snippet(hit.id, wanted[0]);
      line.append(link, where);
      hits.appendChild(line);
    }
    if (wanted.length > 0 && hits.children.length === 0)
      hits.textContent = "No section has all these words. Try fewer, or the beginning of a word.";
  }

  function clear() {
    words.value = "";
    search();
    mark(null);
  }

  // A hit that was chosen makes room for its document on a phone.
  hits.addEventListener("click", (event) => {
    if (narrow.matches && event.target.closest("a")) hits.hidden = true;
  });
  words.addEventListener("focus", () => {
    if (hits.children.length > 0) hits.hidden = false;
  });
  document.addEventListener("keydown", (event) => {
    const at = [words, ...hits.querySelectorAll("a")];
    const here = at.indexOf(document.activeElement);
    if (event.key === "/" && document.activeElement !== words) words.focus();
    else if (event.key === "Escape" && here >= 0) clear();
    else if (event.key === "Enter" && here === 0 && at.length > 1) at[1].click();
    else if (event.key === "ArrowDown" && here >= 0 && here + 1 < at.length) at[here + 1].focus();
    else if (event.key === "ArrowUp" && here > 0) at[here - 1].focus();
    else return;
    event.preventDefault();
  });

  words.addEventListener("input", search);
  window.addEventListener("hashchange", show);
  contents.open = !narrow.matches;
  show();
})();
