"use strict";
// Texts that are deflated (RFC 1950) and written as base64url: pictures of the page, engines of links.
const Packed = (() => {
  async function pack(text) {
    const deflated = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(deflated).arrayBuffer());
    const letters = [...bytes].map((byte) => String.fromCharCode(byte));
    return btoa(letters.join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  }
  // An Error if the text is damaged, or longer than `most` letters.
  async function unpack(packed, most = Infinity) {
    const letters = atob(packed.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
    const decoder = new TextDecoder();
    let text = "";
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      text += decoder.decode(part.value, { stream: true });
      if (text.length > most) throw new Error("the text is too long");
    }
    return text + decoder.decode();
  }
  return { pack, unpack };
})();
