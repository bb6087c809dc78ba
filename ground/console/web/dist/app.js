function na(n,e){return n!==null&&typeof n=="object"&&"$typeName"in n&&typeof n.$typeName=="string"?e===void 0?!0:e.typeName===n.$typeName:!1}var q;(function(n){n[n.DOUBLE=1]="DOUBLE",n[n.FLOAT=2]="FLOAT",n[n.INT64=3]="INT64",n[n.UINT64=4]="UINT64",n[n.INT32=5]="INT32",n[n.FIXED64=6]="FIXED64",n[n.FIXED32=7]="FIXED32",n[n.BOOL=8]="BOOL",n[n.STRING=9]="STRING",n[n.BYTES=12]="BYTES",n[n.UINT32=13]="UINT32",n[n.SFIXED32=15]="SFIXED32",n[n.SFIXED64=16]="SFIXED64",n[n.SINT32=17]="SINT32",n[n.SINT64=18]="SINT64"})(q||(q={}));function Yp(){let n=this.buf,e=this.pos,t=0,i=0;for(let r=0;r<28;r+=7){let o=n[e++];if(t|=(o&127)<<r,(o&128)==0){this.pos=e,this.assertBounds(),this.varint64Lo=t,this.varint64Hi=i;return}}let s=n[e++];if(t|=(s&15)<<28,i=(s&112)>>4,(s&128)==0){this.pos=e,this.assertBounds(),this.varint64Lo=t,this.varint64Hi=i;return}for(let r=3;r<=31;r+=7){let o=n[e++];if(i|=(o&127)<<r,(o&128)==0){this.pos=e,this.assertBounds(),this.varint64Lo=t,this.varint64Hi=i;return}}throw new Error("invalid varint")}var xl=4294967296;function Uh(n){let e=n[0]==="-";e&&(n=n.slice(1));let t=1e6,i=0,s=0;function r(o,a){let c=Number(n.slice(o,a));s*=t,i=i*t+c,i>=xl&&(s=s+(i/xl|0),i=i%xl)}return r(-24,-18),r(-18,-12),r(-12,-6),r(-6),e?Kp(i,s):Bh(i,s)}function Zp(n,e){let t=Bh(n,e),i=t.hi&2147483648;i&&(t=Kp(t.lo,t.hi));let s=Oh(t.lo,t.hi);return i?"-"+s:s}function Oh(n,e){if({lo:n,hi:e}=Nx(n,e),e<=2097151)return String(xl*e+n);let t=n&16777215,i=(n>>>24|e<<8)&16777215,s=e>>16&65535,r=t+i*6777216+s*6710656,o=i+s*8147497,a=s*2,c=1e7;return r>=c&&(o+=Math.floor(r/c),r%=c),o>=c&&(a+=Math.floor(o/c),o%=c),a.toString()+Xp(o)+Xp(r)}function Nx(n,e){return{lo:n>>>0,hi:e>>>0}}function Bh(n,e){return{lo:n|0,hi:e|0}}function Kp(n,e){return e=~e,n?n=~n+1:e+=1,Bh(n,e)}var Xp=n=>{let e=String(n);return"0000000".slice(e.length)+e};function $p(n,e){if(n>>>0<128){e.push(n);return}if(n>=0){for(;n>127;)e.push(n&127|128),n=n>>>7;e.push(n)}else{for(let t=0;t<9;t++)e.push(n&127|128),n=n>>7;e.push(1)}}function qp(){let n=this.buf[this.pos++];if((n&128)===0)return this.assertBounds(),n;let e=n&127;if(n=this.buf[this.pos++],e|=(n&127)<<7,(n&128)===0)return this.assertBounds(),e;if(n=this.buf[this.pos++],e|=(n&127)<<14,(n&128)===0)return this.assertBounds(),e;if(n=this.buf[this.pos++],e|=(n&127)<<21,(n&128)===0)return this.assertBounds(),e;n=this.buf[this.pos++],e|=(n&15)<<28;for(let t=5;(n&128)!==0&&t<10;t++)n=this.buf[this.pos++];if((n&128)!==0)throw new Error("invalid varint");return this.assertBounds(),e>>>0}var Tt=Px();function Px(){let n=new DataView(new ArrayBuffer(8));if(typeof BigInt=="function"&&typeof n.getBigInt64=="function"&&typeof n.getBigUint64=="function"&&typeof n.setBigInt64=="function"&&typeof n.setBigUint64=="function"&&(!!globalThis.Deno||!!globalThis.Bun||typeof process!="object"||typeof process.env!="object"||process.env.BUF_BIGINT_DISABLE!=="1")){let t=BigInt("-9223372036854775808"),i=BigInt("9223372036854775807"),s=BigInt("0"),r=BigInt("18446744073709551615");return{zero:BigInt(0),supported:!0,parse(o){let a=typeof o=="bigint"?o:BigInt(o);if(a>i||a<t)throw new Error(`invalid int64: ${o}`);return a},uParse(o){let a=typeof o=="bigint"?o:BigInt(o);if(a>r||a<s)throw new Error(`invalid uint64: ${o}`);return a},enc(o){return n.setBigInt64(0,this.parse(o),!0),{lo:n.getInt32(0,!0),hi:n.getInt32(4,!0)}},uEnc(o){return n.setBigInt64(0,this.uParse(o),!0),{lo:n.getInt32(0,!0),hi:n.getInt32(4,!0)}},dec(o,a){return n.setInt32(0,o,!0),n.setInt32(4,a,!0),n.getBigInt64(0,!0)},uDec(o,a){return n.setInt32(0,o,!0),n.setInt32(4,a,!0),n.getBigUint64(0,!0)}}}return{zero:"0",supported:!1,parse(t){return typeof t!="string"&&(t=t.toString()),Jp(t),t},uParse(t){return typeof t!="string"&&(t=t.toString()),jp(t),t},enc(t){return typeof t!="string"&&(t=t.toString()),Jp(t),Uh(t)},uEnc(t){return typeof t!="string"&&(t=t.toString()),jp(t),Uh(t)},dec(t,i){return Zp(t,i)},uDec(t,i){return Oh(t,i)}}}function Jp(n){if(!/^-?[0-9]+$/.test(n))throw new Error("invalid int64: "+n)}function jp(n){if(!/^[0-9]+$/.test(n))throw new Error("invalid uint64: "+n)}function ms(n,e){switch(n){case q.STRING:return"";case q.BOOL:return!1;case q.DOUBLE:case q.FLOAT:return 0;case q.INT64:case q.UINT64:case q.SFIXED64:case q.FIXED64:case q.SINT64:return e?"0":Tt.zero;case q.BYTES:return new Uint8Array(0);default:return 0}}function Qp(n,e){switch(n){case q.BOOL:return e===!1;case q.STRING:return e==="";case q.BYTES:return e instanceof Uint8Array&&!e.byteLength;case q.DOUBLE:case q.FLOAT:return Object.is(e,0);default:return e==0}}var em=2,bi=Symbol.for("reflect unsafe local");function tm(n,e){let t=n[e.localName].case;return t===void 0?t:e.fields.find(i=>i.localName===t)}function nm(n,e){let t=e.localName;if(e.oneof)return n[e.oneof.localName].case===t;if(e.presence!=em)return n[t]!==void 0&&Object.prototype.hasOwnProperty.call(n,t);switch(e.fieldKind){case"list":return n[t].length>0;case"map":return Object.keys(n[t]).length>0;case"scalar":return!Qp(e.scalar,n[t]);case"enum":return n[t]!==e.enum.values[0].number}throw new Error("message field with implicit presence")}function gr(n,e){return Object.prototype.hasOwnProperty.call(n,e)&&n[e]!==void 0}function im(n,e){if(e.oneof){let t=n[e.oneof.localName];return t.case===e.localName?t.value:void 0}return n[e.localName]}function sm(n,e,t){e.oneof?n[e.oneof.localName]={case:e.localName,value:t}:n[e.localName]=t}function gs(n,e,t){e==="__proto__"?Object.defineProperty(n,"__proto__",{value:t,writable:!0,enumerable:!0,configurable:!0}):n[e]=t}function rm(n,e){return Object.prototype.hasOwnProperty.call(n,e)?n[e]:void 0}function om(n,e){let t=e.localName;if(e.oneof){let i=e.oneof.localName;n[i].case===t&&(n[i]={case:void 0})}else if(e.presence!=em)delete n[t];else switch(e.fieldKind){case"map":n[t]={};break;case"list":n[t]=[];break;case"enum":n[t]=e.enum.values[0].number;break;case"scalar":n[t]=ms(e.scalar,e.longAsString);break}}function Di(n){return n!==null&&typeof n=="object"&&!Array.isArray(n)}function ia(n,e){var t,i,s,r;if(Di(n)&&bi in n&&"add"in n&&"field"in n&&typeof n.field=="function"){if(e!==void 0){let o=e,a=n.field();return o.listKind==a.listKind&&o.scalar===a.scalar&&((t=o.message)===null||t===void 0?void 0:t.typeName)===((i=a.message)===null||i===void 0?void 0:i.typeName)&&((s=o.enum)===null||s===void 0?void 0:s.typeName)===((r=a.enum)===null||r===void 0?void 0:r.typeName)}return!0}return!1}function sa(n,e){var t,i,s,r;if(Di(n)&&bi in n&&"has"in n&&"field"in n&&typeof n.field=="function"){if(e!==void 0){let o=e,a=n.field();return o.mapKey===a.mapKey&&o.mapKind==a.mapKind&&o.scalar===a.scalar&&((t=o.message)===null||t===void 0?void 0:t.typeName)===((i=a.message)===null||i===void 0?void 0:i.typeName)&&((s=o.enum)===null||s===void 0?void 0:s.typeName)===((r=a.enum)===null||r===void 0?void 0:r.typeName)}return!0}return!1}function _r(n,e){return Di(n)&&bi in n&&"desc"in n&&Di(n.desc)&&n.desc.kind==="message"&&(e===void 0||n.desc.typeName==e.typeName)}function am(n){return lm(n.$typeName)}function jr(n){let e=n.fields[0];return lm(n.typeName)&&e!==void 0&&e.fieldKind=="scalar"&&e.name=="value"&&e.number==1}var Lx=new Set(["google.protobuf.DoubleValue","google.protobuf.FloatValue","google.protobuf.Int64Value","google.protobuf.UInt64Value","google.protobuf.Int32Value","google.protobuf.UInt32Value","google.protobuf.BoolValue","google.protobuf.StringValue","google.protobuf.BytesValue"]);function lm(n){return Lx.has(n)}var Dx=999,Fx=998,um=2;function sn(n,e){return na(e,n)?e:hm(n)(e)}var cm=new WeakMap;function hm(n){let e=cm.get(n);return e===void 0&&(e=Ux(n),cm.set(n,e)),e}var kh=0,dm=1,fm=2,pm=3;function Ux(n){let e=n.typeName,{properties:t,prototype:i}=Ox(n);return s=>{let r;i!==void 0?(r=Object.create(i),r.$typeName=e):r={$typeName:e};for(let o=0;o<t.length;o++){let a=t[o],c=a.name,l=s?.[c];switch(a.kind){case kh:l!=null?r[c]=a.convert!==void 0?a.convert(l):l:a.constant!==void 0&&(r[c]=a.constant);break;case dm:r[c]=a.convert!==void 0&&Array.isArray(l)?l.map(a.convert):l??[];break;case fm:if(a.convert===void 0||!Di(l))r[c]=l??{};else{let h={},u=Object.keys(l);for(let d=0;d<u.length;d++)gs(h,u[d],a.convert(l[u[d]]));r[c]=h}break;case pm:{let h=l;if(h?.case!=null){let u=a.convert.get(h.case);if(u!==void 0){r[c]={case:h.case,value:u(h.value)};break}}r[c]={case:void 0};break}}}return r}}function Ox(n){var e,t;let i=[],s={},r=kx(n);for(let o of n.members){let a=o.localName;if(o.kind=="oneof"){i.push({name:a,kind:pm,constant:void 0,convert:Bx(o)});continue}switch(o.fieldKind){case"message":{i.push({name:a,kind:kh,constant:void 0,convert:vl(o)});break}case"list":{i.push({name:a,kind:dm,constant:void 0,convert:o.listKind=="message"?(e=vl(o))!==null&&e!==void 0?e:(c=>c):o.scalar==q.BYTES?ra:void 0});break}case"map":{i.push({name:a,kind:fm,constant:void 0,convert:o.mapKind=="message"?(t=vl(o))!==null&&t!==void 0?t:(c=>c):o.scalar==q.BYTES?ra:void 0});break}default:{let c=Gx(o);i.push({name:a,kind:kh,constant:o.presence==um?c:void 0,convert:o.fieldKind=="scalar"&&o.scalar==q.BYTES?ra:void 0}),r&&(s[a]=c);break}}}return{properties:i,prototype:r?s:void 0}}function Bx(n){let e=new Map;for(let t of n.fields){let i;t.fieldKind=="message"?i=vl(t):t.fieldKind=="scalar"&&t.scalar==q.BYTES&&(i=ra),e.set(t.localName,i??(s=>s))}return e}function vl(n){if(n.fieldKind=="message"&&!n.oneof&&jr(n.message))return n.message.fields[0].scalar==q.BYTES?ra:void 0;if(n.message.typeName=="google.protobuf.Struct"&&n.parent.typeName!=="google.protobuf.Value")return;let e=n.message,t;return i=>!Di(i)||na(i,e)?i:(t??(t=hm(e)),t(i))}function ra(n){return Array.isArray(n)?new Uint8Array(n):n}function kx(n){switch(n.file.edition){case Dx:return!1;case Fx:return!0;default:return n.fields.some(e=>e.presence!=um&&e.fieldKind!="message"&&!e.oneof)}}function Gx(n){let e=n.getDefaultValue();return e!==void 0?n.fieldKind=="scalar"&&n.longAsString?e.toString():e:n.fieldKind=="scalar"?ms(n.scalar,n.longAsString):n.enum.values[0].number}var Si=class extends Error{constructor(e,t,i="FieldValueInvalidError"){super(t),this.name=i,this.field=()=>e}};var Gh;function Vx(n){var e;Gh=Object.assign(Object.assign({},n),{encodeUtf8Into:(e=n.encodeUtf8Into)!==null&&e!==void 0?e:Vh(n.encodeUtf8.bind(n))})}function oa(){if(!Gh){let n=globalThis;if(!n.TextEncoder||!n.TextDecoder)throw new Error("encoding API missing: install TextEncoder and TextDecoder on globalThis");let e=new n.TextEncoder,t=new n.TextDecoder("utf-8",{ignoreBOM:!0}),i,s={encodeUtf8(o){return e.encode(o)},decodeUtf8(o,a){return a?(i||(i=new n.TextDecoder("utf-8",{fatal:!0,ignoreBOM:!0})),i.decode(o)):t.decode(o)},checkUtf8(o){try{return encodeURIComponent(o),!0}catch{return!1}}};e.encodeInto&&(s.encodeUtf8Into=e.encodeInto.bind(e));let r=String.prototype.isWellFormed;r&&(s.checkUtf8=o=>r.call(o)),Vx(s)}return Gh}function Vh(n){return(e,t)=>{let i=n(e);return t.set(i),{written:i.byteLength}}}var Ot;(function(n){n[n.Varint=0]="Varint",n[n.Bit64=1]="Bit64",n[n.LengthDelimited=2]="LengthDelimited",n[n.StartGroup=3]="StartGroup",n[n.EndGroup=4]="EndGroup",n[n.Bit32=5]="Bit32"})(Ot||(Ot={}));var Wh=4294967295,Xh=2147483647,Yh=-2147483648,bl=class{constructor(e){this.stackPos=[],this.encodeUtf8Into=e?Vh(e):oa().encodeUtf8Into,this.buffer=gm,this.viewCache=Hx,this.pos=0}ensureCapacity(e){let t=this.pos+e;if(t>this.buffer.length){let i=this.buffer.length||zx;for(;i<t;)i*=2;let s=new Uint8Array(i);this.pos>0&&s.set(this.buffer),this.buffer=s}}view(){let e=this.buffer,t=this.viewCache;if(t.byteLength===e.byteLength)return t;let i=new DataView(e.buffer);return this.viewCache=i,i}finish(){let e=this.buffer.slice(0,this.pos);return this.pos=0,this.stackPos=[],e}fork(){return this.stackPos.push(this.pos),this.ensureCapacity(aa),this.buffer[this.pos++]=0,this}join(){let e=this.stackPos.pop();if(e===void 0)throw new Error("invalid state, fork stack empty");let t=this.pos-e-aa,i=zh(t);return i>aa&&(this.ensureCapacity(i-aa),this.buffer.copyWithin(e+i,e+aa,this.pos)),this.pos=e,this.uint32(t),this.pos+=t,this}tag(e,t){return this.uint32((e<<3|t)>>>0)}raw(e){return this.ensureCapacity(e.length),this.buffer.set(e,this.pos),this.pos+=e.length,this}uint32(e){if(mm(e),this.ensureCapacity(5),e<128)return this.buffer[this.pos++]=e,this;for(;e>127;)this.buffer[this.pos++]=e&127|128,e>>>=7;return this.buffer[this.pos++]=e,this}int32(e){if(Hh(e),e>=0)return this.uint32(e);this.ensureCapacity(10);for(let t=0;t<9;t++)this.buffer[this.pos++]=e&127|128,e>>=7;return this.buffer[this.pos++]=1,this}bool(e){return this.ensureCapacity(1),this.buffer[this.pos++]=e?1:0,this}bytes(e){return this.uint32(e.byteLength),this.raw(e)}string(e){typeof e!="string"&&(e=String(e));let t=e.length;if(t<=_m){this.ensureCapacity(t+1);let c=this.buffer,l=this.pos;c[l++]=t;let h=0;for(;h<t;h++){let u=e.charCodeAt(h);if(u>127)break;c[l++]=u}if(h==t)return this.pos=l,this}this.ensureCapacity(t*3+5);let i=zh(t),s=this.buffer,r=this.pos,{written:o}=this.encodeUtf8Into(e,s.subarray(r+i)),a=zh(o);return a!=i&&s.copyWithin(r+a,r+i,r+i+o),this.uint32(o),this.pos+=o,this}float(e){return Wx(e),this.ensureCapacity(4),this.view().setFloat32(this.pos,e,!0),this.pos+=4,this}double(e){return this.ensureCapacity(8),this.view().setFloat64(this.pos,e,!0),this.pos+=8,this}fixed32(e){return mm(e),this.ensureCapacity(4),this.view().setUint32(this.pos,e,!0),this.pos+=4,this}sfixed32(e){return Hh(e),this.ensureCapacity(4),this.view().setInt32(this.pos,e,!0),this.pos+=4,this}sint32(e){return Hh(e),this.uint32((e<<1^e>>31)>>>0)}sfixed64(e){let t=Tt.enc(e);this.ensureCapacity(8);let i=this.view();return i.setInt32(this.pos,t.lo,!0),i.setInt32(this.pos+4,t.hi,!0),this.pos+=8,this}fixed64(e){let t=Tt.uEnc(e);this.ensureCapacity(8);let i=this.view();return i.setInt32(this.pos,t.lo,!0),i.setInt32(this.pos+4,t.hi,!0),this.pos+=8,this}int64(e){let t=Tt.enc(e);return this.writeVarint64(t.lo,t.hi)}sint64(e){let t=Tt.enc(e),i=t.hi>>31,s=t.lo<<1^i,r=(t.hi<<1|t.lo>>>31)^i;return this.writeVarint64(s,r)}uint64(e){let t=Tt.uEnc(e);return this.writeVarint64(t.lo,t.hi)}writeVarint64(e,t){this.ensureCapacity(10);let i=this.buffer,s=this.pos;for(let a=0;a<28;a=a+7){let c=e>>>a,l=!(!(c>>>7)&&t==0);if(i[s++]=(l?c|128:c)&255,!l)return this.pos=s,this}let r=e>>>28&15|(t&7)<<4,o=t>>3!=0;if(i[s++]=(o?r|128:r)&255,!o)return this.pos=s,this;for(let a=3;a<31;a=a+7){let c=t>>>a,l=!!(c>>>7);if(i[s++]=(l?c|128:c)&255,!l)return this.pos=s,this}return i[s++]=t>>>31&1,this.pos=s,this}},zx=128,aa=1,gm=new Uint8Array(0),Hx=new DataView(gm.buffer),_m=32;function zh(n){return n<128?1:n<16384?2:n<2097152?3:n<268435456?4:5}var yr=class{constructor(e,t=oa().decodeUtf8){this.decodeUtf8=t,this.varint64Lo=0,this.varint64Hi=0,this.varint64=Yp,this.uint32=qp,this.buf=e,this.len=e.length,this.pos=0,this.view=new DataView(e.buffer,e.byteOffset,e.byteLength)}tag(){let e=this.pos,t=this.uint32(),i=this.pos-e;if(i>5||i==5&&this.buf[this.pos-1]>15)throw new Error("illegal tag: varint overflows uint32");let s=t>>>3,r=t&7;if(s<=0||r>5)throw new Error("illegal tag: field no "+s+" wire type "+r);return[s,r]}skip(e,t,i=100){let s=this.pos;switch(e){case Ot.Varint:for(;this.buf[this.pos++]&128;);break;case Ot.Bit64:this.pos+=4;case Ot.Bit32:this.pos+=4;break;case Ot.LengthDelimited:let r=this.uint32();this.pos+=r;break;case Ot.StartGroup:if(i<=0)throw new Error("maximum recursion depth reached");for(;;){let[o,a]=this.tag();if(a===Ot.EndGroup){if(t!==void 0&&o!==t)throw new Error("invalid end group tag");break}this.skip(a,o,i-1)}break;default:throw new Error("cant skip wire type "+e)}return this.assertBounds(),this.buf.subarray(s,this.pos)}assertBounds(){if(this.pos>this.len)throw new RangeError("premature EOF")}int32(){return this.uint32()|0}sint32(){let e=this.uint32();return e>>>1^-(e&1)}int64(){return this.varint64(),Tt.dec(this.varint64Lo,this.varint64Hi)}uint64(){return this.varint64(),Tt.uDec(this.varint64Lo,this.varint64Hi)}sint64(){this.varint64();let e=this.varint64Lo,t=this.varint64Hi,i=-(e&1);return e=(e>>>1|(t&1)<<31)^i,t=t>>>1^i,Tt.dec(e,t)}bool(){let e=this.buf[this.pos];return e<128?(this.pos++,e!==0):(this.varint64(),this.varint64Lo!==0||this.varint64Hi!==0)}fixed32(){return this.view.getUint32((this.pos+=4)-4,!0)}sfixed32(){return this.view.getInt32((this.pos+=4)-4,!0)}fixed64(){return Tt.uDec(this.sfixed32(),this.sfixed32())}sfixed64(){return Tt.dec(this.sfixed32(),this.sfixed32())}float(){return this.view.getFloat32((this.pos+=4)-4,!0)}double(){return this.view.getFloat64((this.pos+=8)-8,!0)}bytes(){let e=this.uint32(),t=this.pos;return this.pos+=e,this.assertBounds(),this.buf.subarray(t,t+e)}string(e){let t=this.uint32(),i=this.pos;this.pos+=t,this.assertBounds();let s=this.buf;if(t<=_m){let r=new Array(t);for(let o=0;o<t;o++){let a=s[i+o];if(a>127)return this.decodeUtf8(s.subarray(i,this.pos),e);r[o]=a}return String.fromCharCode.apply(String,r)}return this.decodeUtf8(s.subarray(i,this.pos),e)}};function Hh(n){if(typeof n=="string")n=Number(n);else if(typeof n!="number")throw new Error("invalid int32: "+typeof n);if(!Number.isInteger(n)||n>Xh||n<Yh)throw new Error("invalid int32: "+n)}function mm(n){if(typeof n=="string")n=Number(n);else if(typeof n!="number")throw new Error("invalid uint32: "+typeof n);if(!Number.isInteger(n)||n>Wh||n<0)throw new Error("invalid uint32: "+n)}function Wx(n){if(typeof n=="string"){let e=n;if(n=Number(n),Number.isNaN(n)&&e!=="NaN")throw new Error("invalid float32: "+e)}else if(typeof n!="number")throw new Error("invalid float32: "+typeof n);if(!Number.isFinite(Math.fround(n))&&Number.isFinite(n))throw new Error("invalid float32: "+n)}function ym(n,e){let t=n.fieldKind=="list"?ia(e,n):n.fieldKind=="map"?sa(e,n):$h(n,e);if(t===!0)return;let i;switch(n.fieldKind){case"list":i=`expected ${bm(n)}, got ${Ml(e)}`;break;case"map":i=`expected ${Sm(n)}, got ${Ml(e)}`;break;default:i=Sl(n,e,t)}return new Si(n,i)}function Kh(n,e,t){let i=$h(n,t);if(i!==!0)return new Si(n,`list item #${e+1}: ${Sl(n,t,i)}`)}function xm(n,e,t){let i=Zh(n.mapKey)(e);if(i!==!0)return new Si(n,`invalid map key: ${Sl({scalar:n.mapKey},e,i)}`);let s=$h(n,t);if(s!==!0)return new Si(n,`map entry ${Ml(e)}: ${Sl(n,t,s)}`)}function $h(n,e){return n.scalar!==void 0?Zh(n.scalar)(e):n.enum!==void 0?n.enum.open?Zh(q.INT32)(e):n.enum.values.some(t=>t.number===e):_r(e,n.message)}function Zh(n){switch(n){case q.DOUBLE:return e=>typeof e=="number";case q.FLOAT:return e=>typeof e!="number"?!1:!Number.isFinite(Math.fround(e))&&Number.isFinite(e)?`${e.toFixed()} out of range`:!0;case q.INT32:case q.SFIXED32:case q.SINT32:return e=>typeof e!="number"||!Number.isInteger(e)?!1:e>Xh||e<Yh?`${e.toFixed()} out of range`:!0;case q.FIXED32:case q.UINT32:return e=>typeof e!="number"||!Number.isInteger(e)?!1:e>Wh||e<0?`${e.toFixed()} out of range`:!0;case q.BOOL:return e=>typeof e=="boolean";case q.STRING:return e=>typeof e!="string"?!1:oa().checkUtf8(e)||"invalid UTF8";case q.BYTES:return e=>e instanceof Uint8Array;case q.INT64:case q.SFIXED64:case q.SINT64:return e=>{if(typeof e=="bigint"||typeof e=="number"||typeof e=="string"&&e.length>0)try{return Tt.parse(e),!0}catch{return`${e} out of range`}return!1};case q.FIXED64:case q.UINT64:return e=>{if(typeof e=="bigint"||typeof e=="number"||typeof e=="string"&&e.length>0)try{return Tt.uParse(e),!0}catch{return`${e} out of range`}return!1}}}function Sl(n,e,t){return t=typeof t=="string"?`: ${t}`:`, got ${Ml(e)}`,n.scalar!==void 0?`expected ${Xx(n.scalar)}`+t:n.enum!==void 0?`expected ${n.enum.toString()}`+t:`expected ${vm(n.message)}`+t}function Ml(n){switch(typeof n){case"object":return n===null?"null":n instanceof Uint8Array?`Uint8Array(${n.length})`:Array.isArray(n)?`Array(${n.length})`:ia(n)?bm(n.field()):sa(n)?Sm(n.field()):_r(n)?vm(n.desc):na(n)?`message ${n.$typeName}`:"object";case"string":return n.length>30?"string":`"${n.split('"').join('\\"')}"`;case"boolean":return String(n);case"number":return String(n);case"bigint":return String(n)+"n";default:return typeof n}}function vm(n){return`ReflectMessage (${n.typeName})`}function bm(n){switch(n.listKind){case"message":return`ReflectList (${n.message.toString()})`;case"enum":return`ReflectList (${n.enum.toString()})`;case"scalar":return`ReflectList (${q[n.scalar]})`}}function Sm(n){switch(n.mapKind){case"message":return`ReflectMap (${q[n.mapKey]}, ${n.message.toString()})`;case"enum":return`ReflectMap (${q[n.mapKey]}, ${n.enum.toString()})`;case"scalar":return`ReflectMap (${q[n.mapKey]}, ${q[n.scalar]})`}}function Xx(n){switch(n){case q.STRING:return"string";case q.BOOL:return"boolean";case q.INT64:case q.SINT64:case q.SFIXED64:return"bigint (int64)";case q.UINT64:case q.FIXED64:return"bigint (uint64)";case q.BYTES:return"Uint8Array";case q.DOUBLE:return"number (float64)";case q.FLOAT:return"number (float32)";case q.FIXED32:case q.UINT32:return"number (uint32)";case q.INT32:case q.SFIXED32:case q.SINT32:return"number (int32)"}}var Yx=0;function Ws(n){if(Zx(n))return{toMessage:t=>El(t),toLocal:t=>Al(t)};if(n.fieldKind=="message"&&!n.oneof&&jr(n.message)){let t=n.message,i=t.fields[0].localName;return{toMessage:s=>{let r=sn(t);return s!==void 0&&(r[i]=s),r},toLocal:s=>s[i]}}let e=n.message;return{toMessage:t=>t===void 0?sn(e):t,toLocal:t=>t}}function Zx(n){return n.message.typeName=="google.protobuf.Struct"&&n.parent.typeName!="google.protobuf.Value"}function El(n){let e={$typeName:"google.protobuf.Struct",fields:{}};if(Di(n))for(let t of Object.keys(n))gs(e.fields,t,Em(n[t]));return e}function Al(n){let e={};for(let t of Object.keys(n.fields))gs(e,t,Mm(n.fields[t]));return e}function Mm(n){switch(n.kind.case){case"structValue":return Al(n.kind.value);case"listValue":return n.kind.value.values.map(Mm);case"nullValue":case void 0:return null;default:return n.kind.value}}function Em(n){let e={$typeName:"google.protobuf.Value",kind:{case:void 0}};switch(typeof n){case"number":e.kind={case:"numberValue",value:n};break;case"string":e.kind={case:"stringValue",value:n};break;case"boolean":e.kind={case:"boolValue",value:n};break;case"object":if(n===null)e.kind={case:"nullValue",value:Yx};else if(Array.isArray(n)){let t={$typeName:"google.protobuf.ListValue",values:[]};if(Array.isArray(n))for(let i of n)t.values.push(Em(i));e.kind={case:"listValue",value:t}}else e.kind={case:"structValue",value:El(n)};break}return e}function ed(n,e,t=!0){return new wl(n,e,t)}var Am=new WeakMap,wl=class{get sortedFields(){let e=Am.get(this.desc);if(e)return e;let t=this.desc.fields.concat().sort((i,s)=>i.number-s.number);return Am.set(this.desc,t),t}constructor(e,t,i=!0){this.lists=new Map,this.maps=new Map,this.check=i,this.desc=e,this.message=this[bi]=t??sn(e),this.fields=e.fields,this.oneofs=e.oneofs,this.members=e.members}findNumber(e){return this._fieldsByNumber||(this._fieldsByNumber=new Map(this.desc.fields.map(t=>[t.number,t]))),this._fieldsByNumber.get(e)}oneofCase(e){return la(this.message,e),tm(this.message,e)}isSet(e){return la(this.message,e),nm(this.message,e)}clear(e){la(this.message,e),om(this.message,e)}get(e){la(this.message,e);let t=im(this.message,e);switch(e.fieldKind){case"list":let i=this.lists.get(e);return(!i||i[bi]!==t)&&this.lists.set(e,i=new jh(e,t,this.check)),i;case"map":let s=this.maps.get(e);return(!s||s[bi]!==t)&&this.maps.set(e,s=new Qh(e,t,this.check)),s;case"message":return nd(e,t,this.check);case"scalar":return t===void 0?ms(e.scalar,!1):id(e,t);case"enum":return t??e.enum.values[0].number}}set(e,t){if(la(this.message,e),this.check){let s=ym(e,t);if(s)throw s}let i;e.fieldKind=="message"?i=td(e,t):sa(t)||ia(t)?i=t[bi]:i=sd(e,t),sm(this.message,e,i)}getUnknown(){return this.message.$unknown}setUnknown(e){this.message.$unknown=e}};function la(n,e){if(e.parent.typeName!==n.$typeName)throw new Si(e,`cannot use ${e.toString()} with message ${n.$typeName}`,"ForeignFieldError")}var jh=class{field(){return this._field}get size(){return this._arr.length}constructor(e,t,i){this._field=e,this._arr=this[bi]=t,this.check=i}get(e){let t=this._arr[e];return t===void 0?void 0:qh(this._field,t,this.check)}set(e,t){if(e<0||e>=this._arr.length)throw new Si(this._field,`list item #${e+1}: out of range`);if(this.check){let i=Kh(this._field,e,t);if(i)throw i}this._arr[e]=Tm(this._field,t)}add(e){if(this.check){let t=Kh(this._field,this._arr.length,e);if(t)throw t}this._arr.push(Tm(this._field,e))}clear(){this._arr.splice(0,this._arr.length)}[Symbol.iterator](){return this.values()}keys(){return this._arr.keys()}*values(){for(let e of this._arr)yield qh(this._field,e,this.check)}*entries(){for(let e=0;e<this._arr.length;e++)yield[e,qh(this._field,this._arr[e],this.check)]}};var Qh=class{constructor(e,t,i=!0){this.obj=this[bi]=t??{},this.check=i,this._field=e}field(){return this._field}set(e,t){if(this.check){let i=xm(this._field,e,t);if(i)throw i}return gs(this.obj,Tl(e),Kx(this._field,t)),this}delete(e){let t=Tl(e),i=Object.prototype.hasOwnProperty.call(this.obj,t);return i&&delete this.obj[t],i}clear(){for(let e of Object.keys(this.obj))delete this.obj[e]}get(e){let t=rm(this.obj,Tl(e));return t!==void 0&&(t=Jh(this._field,t,this.check)),t}has(e){return Object.prototype.hasOwnProperty.call(this.obj,Tl(e))}*keys(){for(let e of Object.keys(this.obj))yield wm(e,this._field.mapKey)}*entries(){for(let e of Object.entries(this.obj))yield[wm(e[0],this._field.mapKey),Jh(this._field,e[1],this.check)]}[Symbol.iterator](){return this.entries()}get size(){return Object.keys(this.obj).length}*values(){for(let e of Object.values(this.obj))yield Jh(this._field,e,this.check)}forEach(e,t){for(let i of this.entries())e.call(t,i[1],i[0],this)}};function td(n,e){return _r(e)?am(e.message)&&!n.oneof&&n.fieldKind=="message"?e.message.value:e.desc.typeName=="google.protobuf.Struct"&&n.parent.typeName!="google.protobuf.Value"?Al(e.message):e.message:e}function nd(n,e,t){return e!==void 0&&(jr(n.message)&&!n.oneof&&n.fieldKind=="message"?e={$typeName:n.message.typeName,value:id(n.message.fields[0],e)}:n.message.typeName=="google.protobuf.Struct"&&n.parent.typeName!="google.protobuf.Value"&&Di(e)&&(e=El(e))),new wl(n.message,e,t)}function Tm(n,e){return n.listKind=="message"?td(n,e):sd(n,e)}function qh(n,e,t){return n.listKind=="message"?nd(n,e,t):id(n,e)}function Kx(n,e){return n.mapKind=="message"?td(n,e):sd(n,e)}function Jh(n,e,t){return n.mapKind=="message"?nd(n,e,t):e}function Tl(n){return typeof n=="string"||typeof n=="number"?n:String(n)}function wm(n,e){switch(e){case q.STRING:return n;case q.INT32:case q.FIXED32:case q.UINT32:case q.SFIXED32:case q.SINT32:{let t=Number.parseInt(n);if(Number.isFinite(t))return t;break}case q.BOOL:switch(n){case"true":return!0;case"false":return!1}break;case q.UINT64:case q.FIXED64:try{return Tt.uParse(n)}catch{}break;default:try{return Tt.parse(n)}catch{}break}return n}function id(n,e){switch(n.scalar){case q.INT64:case q.SFIXED64:case q.SINT64:"longAsString"in n&&n.longAsString&&typeof e=="string"&&(e=Tt.parse(e));break;case q.FIXED64:case q.UINT64:"longAsString"in n&&n.longAsString&&typeof e=="string"&&(e=Tt.uParse(e));break}return e}function sd(n,e){switch(n.scalar){case q.INT64:case q.SFIXED64:case q.SINT64:"longAsString"in n&&n.longAsString?e=String(e):(typeof e=="string"||typeof e=="number")&&(e=Tt.parse(e));break;case q.FIXED64:case q.UINT64:"longAsString"in n&&n.longAsString?e=String(e):(typeof e=="string"||typeof e=="number")&&(e=Tt.uParse(e));break}return e}function Rm(n,e){return Cm(ed(n,e)).message}function Cm(n){let e=ed(n.desc);for(let i of n.fields)if(n.isSet(i))switch(i.fieldKind){case"list":let s=e.get(i);for(let o of n.get(i))s.add(rd(i,o));break;case"map":let r=e.get(i);for(let o of n.get(i).entries())r.set(o[0],rd(i,o[1]));break;default:{e.set(i,rd(i,n.get(i)));break}}let t=n.getUnknown();return t&&t.length>0&&e.setUnknown([...t]),e}function rd(n,e){return n.message!==void 0&&_r(e)?Cm(e):n.scalar==q.BYTES&&e instanceof Uint8Array?e.slice():e}var Im=Uint8Array.prototype.setFromBase64;function Pm(n){let e=n.length,t=e-(e+3>>2);(e&3)==0&&n[e-1]=="="&&(t-=n[e-2]=="="?2:1);let i=new Uint8Array(t),s=-1;if(Im)try{let r=Im.call(i,n);r.read==e&&(s=r.written)}catch{}return s<0&&(s=$x(i,n)),s==t?i:i.subarray(0,s)}function $x(n,e){let t=Jx(),i=0,s=0,r,o=0;for(let a=0;a<e.length;a++){if(r=t[e.charCodeAt(a)],r===void 0)switch(e[a]){case"=":s=0;case`
`:case"\r":case"	":case" ":continue;default:throw Error("invalid base64 string")}switch(s){case 0:o=r,s=1;break;case 1:n[i++]=o<<2|(r&48)>>4,o=r,s=2;break;case 2:n[i++]=(o&15)<<4|(r&60)>>2,o=r,s=3;break;case 3:n[i++]=(o&3)<<6|r,s=0;break}}if(s==1)throw Error("invalid base64 string");return i}var dC=Uint8Array.prototype.toBase64;var Rl,Nm,Qr;function qx(n){return Rl||(Rl="ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/".split(""),Nm=Rl.slice(0,-2).concat("-","_")),n=="url"?Nm:Rl}function Jx(){if(!Qr){Qr=[];let n=qx("std");for(let e=0;e<n.length;e++)Qr[n[e].charCodeAt(0)]=e;Qr[45]=n.indexOf("+"),Qr[95]=n.indexOf("/")}return Qr}function eo(n){let e=!1,t=[];for(let i=0;i<n.length;i++){let s=n.charAt(i);switch(s){case"_":e=!0;break;case"0":case"1":case"2":case"3":case"4":case"5":case"6":case"7":case"8":case"9":t.push(s),e=!1;break;default:e&&(e=!1,s=s.toUpperCase()),t.push(s);break}}return t.join("")}var jx=new Set(["constructor","toString","toJSON","valueOf"]);function to(n){return jx.has(n)?n+"$":n}function ca(n){for(let e of n.field)gr(e,"jsonName")||(e.jsonName=eo(e.name));n.nestedType.forEach(ca)}function Lm(n,e){let t=n.values.find(i=>i.name===e);if(!t)throw new Error(`cannot parse ${n} default value: ${e}`);return t.number}function Dm(n,e){switch(n){case q.STRING:return e;case q.BYTES:{let t=Qx(e);if(t===!1)throw new Error(`cannot parse ${q[n]} default value: ${e}`);return t}case q.INT64:case q.SFIXED64:case q.SINT64:return Tt.parse(e);case q.UINT64:case q.FIXED64:return Tt.uParse(e);case q.DOUBLE:case q.FLOAT:switch(e){case"inf":return Number.POSITIVE_INFINITY;case"-inf":return Number.NEGATIVE_INFINITY;case"nan":return Number.NaN;default:return parseFloat(e)}case q.BOOL:return e==="true";case q.INT32:case q.UINT32:case q.SINT32:case q.FIXED32:case q.SFIXED32:return parseInt(e,10)}}function Qx(n){let e=[],t={tail:n,c:"",next(){return this.tail.length==0?!1:(this.c=this.tail[0],this.tail=this.tail.substring(1),!0)},take(i){if(this.tail.length>=i){let s=this.tail.substring(0,i);return this.tail=this.tail.substring(i),s}return!1}};for(;t.next();)switch(t.c){case"\\":if(t.next())switch(t.c){case"\\":e.push(t.c.charCodeAt(0));break;case"b":e.push(8);break;case"f":e.push(12);break;case"n":e.push(10);break;case"r":e.push(13);break;case"t":e.push(9);break;case"v":e.push(11);break;case"0":case"1":case"2":case"3":case"4":case"5":case"6":case"7":{let i=t.c,s=t.take(2);if(s===!1)return!1;let r=parseInt(i+s,8);if(Number.isNaN(r))return!1;e.push(r);break}case"x":{let i=t.c,s=t.take(2);if(s===!1)return!1;let r=parseInt(i+s,16);if(Number.isNaN(r))return!1;e.push(r);break}case"u":{let i=t.c,s=t.take(4);if(s===!1)return!1;let r=parseInt(i+s,16);if(Number.isNaN(r))return!1;let o=new Uint8Array(4);new DataView(o.buffer).setInt32(0,r,!0),e.push(o[0],o[1],o[2],o[3]);break}case"U":{let i=t.c,s=t.take(8);if(s===!1)return!1;let r=Tt.uEnc(i+s),o=new Uint8Array(8),a=new DataView(o.buffer);a.setInt32(0,r.lo,!0),a.setInt32(4,r.hi,!0),e.push(o[0],o[1],o[2],o[3],o[4],o[5],o[6],o[7]);break}}break;default:e.push(t.c.charCodeAt(0))}return new Uint8Array(e)}function*Cl(n){switch(n.kind){case"file":for(let e of n.messages)yield e,yield*Cl(e);yield*n.enums,yield*n.services,yield*n.extensions;break;case"message":for(let e of n.nestedMessages)yield e,yield*Cl(e);yield*n.nestedEnums,yield*n.nestedExtensions;break}}function Il(n,e){return ev([n,e])}function ev(n,e){let t=tv();if(!n.length)return t;if("$typeName"in n[0]&&n[0].$typeName=="google.protobuf.FileDescriptorSet"){for(let i of n[0].file)e?.(i),Bm(i,t);return t}if("$typeName"in n[0]){let o=function(a){let c=[];for(let l of a.dependency){if(t.getFile(l)!=null||r.has(l))continue;let h=s(l);if(!h)throw new Error(`Unable to resolve ${l}, imported by ${a.name}`);"kind"in h?t.addFile(h,!1,!0):(r.add(h.name),c.push(h))}return c.concat(...c.map(o))},i=n[0],s=n[1],r=new Set;for(let a of[i,...o(i)].reverse())e?.(a),Bm(a,t)}else for(let i of n)for(let s of i.files)t.addFile(s);return t}function tv(){let n=new Map,e=new Map,t=new Map;return{kind:"registry",types:n,extendees:e,[Symbol.iterator](){return n.values()},get files(){return t.values()},addFile(i,s,r){if(t.set(i.proto.name,i),!s)for(let o of Cl(i))this.add(o);if(r)for(let o of i.dependencies)this.addFile(o,s,r)},add(i){if(i.kind=="extension"){let s=e.get(i.extendee.typeName);s||e.set(i.extendee.typeName,s=new Map),s.set(i.number,i)}n.set(i.typeName,i)},get(i){return n.get(i)},getFile(i){return t.get(i)},getMessage(i){let s=n.get(i);return s?.kind=="message"?s:void 0},getEnum(i){let s=n.get(i);return s?.kind=="enum"?s:void 0},getExtension(i){let s=n.get(i);return s?.kind=="extension"?s:void 0},getExtensionFor(i,s){var r;return(r=e.get(i.typeName))===null||r===void 0?void 0:r.get(s)},getService(i){let s=n.get(i);return s?.kind=="service"?s:void 0}}}var nv=998,iv=999,sv=9999,rv=9,ha=10,ua=11,ov=12,Fm=14,ud=3,av=2,Um=1,lv=0,od=1,Om=2,cv=3,uv=1,hv=2,dv=1,fv=2;var pv=1002,Gm={998:{fieldPresence:1,enumType:2,repeatedFieldEncoding:2,utf8Validation:3,messageEncoding:1,jsonFormat:2,enforceNamingStyle:2,defaultSymbolVisibility:1,enforceProtoLimits:1},999:{fieldPresence:2,enumType:1,repeatedFieldEncoding:1,utf8Validation:2,messageEncoding:1,jsonFormat:1,enforceNamingStyle:2,defaultSymbolVisibility:1,enforceProtoLimits:1},1e3:{fieldPresence:1,enumType:1,repeatedFieldEncoding:1,utf8Validation:2,messageEncoding:1,jsonFormat:1,enforceNamingStyle:2,defaultSymbolVisibility:1,enforceProtoLimits:1},1001:{fieldPresence:1,enumType:1,repeatedFieldEncoding:1,utf8Validation:2,messageEncoding:1,jsonFormat:1,enforceNamingStyle:1,defaultSymbolVisibility:2,enforceProtoLimits:1},1002:{fieldPresence:1,enumType:1,repeatedFieldEncoding:1,utf8Validation:2,messageEncoding:1,jsonFormat:1,enforceNamingStyle:3,defaultSymbolVisibility:4,enforceProtoLimits:2}};function Bm(n,e){var t,i;let s={kind:"file",proto:n,deprecated:(i=(t=n.options)===null||t===void 0?void 0:t.deprecated)!==null&&i!==void 0?i:!1,edition:yv(n),name:n.name.replace(/\.proto$/,""),dependencies:xv(n,e),enums:[],messages:[],extensions:[],services:[],toString(){return`file ${n.name}`}},r=new Map,o={get(a){return r.get(a)},add(a){var c;Fi(((c=a.proto.options)===null||c===void 0?void 0:c.mapEntry)===!0),r.set(a.typeName,a)}};for(let a of n.enumType)Vm(a,s,void 0,e);for(let a of n.messageType)zm(a,s,void 0,e,o);for(let a of n.service)mv(a,s,e);ad(s,e);for(let a of r.values())ld(a,e,o);for(let a of s.messages)ld(a,e,o),ad(a,e);e.addFile(s,!0)}function ad(n,e){switch(n.kind){case"file":for(let t of n.proto.extension){let i=cd(t,n,e);n.extensions.push(i),e.add(i)}break;case"message":for(let t of n.proto.extension){let i=cd(t,n,e);n.nestedExtensions.push(i),e.add(i)}for(let t of n.nestedMessages)ad(t,e);break}}function ld(n,e,t){let i=n.proto.oneofDecl.map(r=>_v(r,n)),s=new Set;for(let r of n.proto.field){let o=Mv(r,i),a=cd(r,n,e,o,t);n.fields.push(a),n.field[a.localName]=a,o===void 0?n.members.push(a):(o.fields.push(a),s.has(o)||(s.add(o),n.members.push(o)))}for(let r of i.filter(o=>s.has(o)))n.oneofs.push(r);for(let r of n.nestedMessages)ld(r,e,t)}function Vm(n,e,t,i){var s,r,o,a,c,l,h,u,d;let f=vv(n.name,n.value),g={kind:"enum",proto:n,deprecated:(r=(s=n.options)===null||s===void 0?void 0:s.deprecated)!==null&&r!==void 0?r:!1,file:e,parent:t,open:!0,name:n.name,typeName:Nl(n,t,e),value:{},values:[],sharedPrefix:f,toString(){return`enum ${this.typeName}`}};g.open=wv(g),i.add(g);for(let v of n.value){let p=v.name,m={kind:"enum_value",proto:v,deprecated:(a=(o=v.options)===null||o===void 0?void 0:o.deprecated)!==null&&a!==void 0?a:!1,parent:g,name:p,localName:to(f==null?p:p.substring(f.length)),number:v.number,jsonName:(c=bv(v))!==null&&c!==void 0?c:p,toString(){return`enum value ${g.typeName}.${p}`}};g.values.push(m),(l=(u=g.value)[d=v.number])!==null&&l!==void 0||(u[d]=m)}((h=t?.nestedEnums)!==null&&h!==void 0?h:e.enums).push(g)}function zm(n,e,t,i,s){var r,o,a,c;let l={kind:"message",proto:n,deprecated:(o=(r=n.options)===null||r===void 0?void 0:r.deprecated)!==null&&o!==void 0?o:!1,file:e,parent:t,name:n.name,typeName:Nl(n,t,e),fields:[],field:{},oneofs:[],members:[],nestedEnums:[],nestedMessages:[],nestedExtensions:[],toString(){return`message ${this.typeName}`}};((a=n.options)===null||a===void 0?void 0:a.mapEntry)===!0?s.add(l):(((c=t?.nestedMessages)!==null&&c!==void 0?c:e.messages).push(l),i.add(l));for(let h of n.enumType)Vm(h,e,l,i);for(let h of n.nestedType)zm(h,e,l,i,s)}function mv(n,e,t){var i,s;let r={kind:"service",proto:n,deprecated:(s=(i=n.options)===null||i===void 0?void 0:i.deprecated)!==null&&s!==void 0?s:!1,file:e,name:n.name,typeName:Nl(n,void 0,e),methods:[],method:{},toString(){return`service ${this.typeName}`}};e.services.push(r),t.add(r);for(let o of n.method){let a=gv(o,r,t);r.methods.push(a),r.method[a.localName]=a}}function gv(n,e,t){var i,s,r,o;let a;n.clientStreaming&&n.serverStreaming?a="bidi_streaming":n.clientStreaming?a="client_streaming":n.serverStreaming?a="server_streaming":a="unary";let c=t.getMessage(_s(n.inputType)),l=t.getMessage(_s(n.outputType));Fi(c,`invalid MethodDescriptorProto: input_type ${n.inputType} not found`),Fi(l,`invalid MethodDescriptorProto: output_type ${n.inputType} not found`);let h=n.name;return{kind:"rpc",proto:n,deprecated:(s=(i=n.options)===null||i===void 0?void 0:i.deprecated)!==null&&s!==void 0?s:!1,parent:e,name:h,localName:to(h.length?to(h[0].toLowerCase()+h.substring(1)):h),methodKind:a,input:c,output:l,idempotency:(o=(r=n.options)===null||r===void 0?void 0:r.idempotencyLevel)!==null&&o!==void 0?o:lv,toString(){return`rpc ${e.typeName}.${h}`}}}function _v(n,e){return{kind:"oneof",proto:n,deprecated:!1,parent:e,fields:[],name:n.name,localName:to(eo(n.name)),toString(){return`oneof ${e.typeName}.${this.name}`}}}function cd(n,e,t,i,s){var r,o,a;let c=s===void 0,l={kind:"field",proto:n,deprecated:(o=(r=n.options)===null||r===void 0?void 0:r.deprecated)!==null&&o!==void 0?o:!1,name:n.name,number:n.number,scalar:void 0,message:void 0,enum:void 0,presence:Ev(n,i,c,e),utf8Validation:Rv(n,e),listKind:void 0,mapKind:void 0,mapKey:void 0,delimitedEncoding:void 0,packed:void 0,longAsString:!1,getDefaultValue:void 0},h;if(c){let g=e.kind=="file"?e:e.file,v=e.kind=="file"?void 0:e,p=Nl(n,v,g);l.kind="extension",l.file=g,l.parent=v,l.oneof=void 0,l.typeName=p,l.jsonName=`[${p}]`,h=()=>`extension ${p}`;let m=t.getMessage(_s(n.extendee));Fi(m,`invalid FieldDescriptorProto: extendee ${n.extendee} not found`),l.extendee=m}else{let g=e;Fi(g.kind=="message"),l.parent=g,l.oneof=i,l.localName=i?eo(n.name):to(eo(n.name)),l.jsonName=n.jsonName,h=()=>`field ${g.typeName}.${n.name}`}Object.defineProperty(l,"toString",{value:h,writable:!0,enumerable:!0,configurable:!0});let u=n.label,d=n.type,f=(a=n.options)===null||a===void 0?void 0:a.jstype;if(u===ud){let g=d==ua?s?.get(_s(n.typeName)):void 0;if(g){l.fieldKind="map";let{key:v,value:p}=Tv(g);return l.mapKey=v.scalar,l.mapKind=p.fieldKind,l.message=p.message,l.delimitedEncoding=!1,l.enum=p.enum,l.scalar=p.scalar,l}switch(l.fieldKind="list",d){case ua:case ha:l.listKind="message",l.message=t.getMessage(_s(n.typeName)),Fi(l.message),l.delimitedEncoding=km(n,e);break;case Fm:l.listKind="enum",l.enum=t.getEnum(_s(n.typeName)),Fi(l.enum);break;default:l.listKind="scalar",l.scalar=d,l.longAsString=f==Um;break}return l.packed=Av(n,e),l}switch(d){case ua:case ha:l.fieldKind="message",l.message=t.getMessage(_s(n.typeName)),Fi(l.message,`invalid FieldDescriptorProto: type_name ${n.typeName} not found`),l.delimitedEncoding=km(n,e),l.getDefaultValue=()=>{};break;case Fm:{let g=t.getEnum(_s(n.typeName));Fi(g!==void 0,`invalid FieldDescriptorProto: type_name ${n.typeName} not found`),l.fieldKind="enum",l.enum=t.getEnum(_s(n.typeName)),l.getDefaultValue=()=>gr(n,"defaultValue")?Lm(g,n.defaultValue):void 0;break}default:{l.fieldKind="scalar",l.scalar=d,l.longAsString=f==Um,l.getDefaultValue=()=>gr(n,"defaultValue")?Dm(d,n.defaultValue):void 0;break}}return l}function yv(n){switch(n.syntax){case"":case"proto2":return nv;case"proto3":return iv;case"editions":if(n.edition===sv)return pv;if(n.edition in Gm)return n.edition;throw new Error(`${n.name}: unsupported edition`);default:throw new Error(`${n.name}: unsupported syntax "${n.syntax}"`)}}function xv(n,e){return n.dependency.map(t=>{let i=e.getFile(t);if(!i)throw new Error(`Cannot find ${t}, imported by ${n.name}`);return i})}function vv(n,e){let t=Sv(n)+"_";for(let i of e){if(!i.name.toLowerCase().startsWith(t))return;let s=i.name.substring(t.length);if(s.length==0||/^\d/.test(s))return}return t}function bv(n){var e,t;let r;for(let o of(t=(e=n.options)===null||e===void 0?void 0:e.$unknown)!==null&&t!==void 0?t:[]){if(o.no!==998||o.wireType!==Ot.LengthDelimited)continue;let a=new yr(new yr(o.data).bytes());for(;a.pos<a.len;){let[c,l]=a.tag();c===1&&l===Ot.LengthDelimited?r=a.string():a.skip(l,c)}}return r}function Sv(n){return(n.substring(0,1)+n.substring(1).replace(/[A-Z]/g,e=>"_"+e)).toLowerCase()}function Nl(n,e,t){let i;return e?i=`${e.typeName}.${n.name}`:t.proto.package.length>0?i=`${t.proto.package}.${n.name}`:i=`${n.name}`,i}function _s(n){return n.startsWith(".")?n.substring(1):n}function Mv(n,e){if(!gr(n,"oneofIndex")||n.proto3Optional)return;let t=e[n.oneofIndex];return Fi(t,`invalid FieldDescriptorProto: oneof #${n.oneofIndex} for field #${n.number} not found`),t}function Ev(n,e,t,i){if(n.label==av)return cv;if(n.label==ud)return Om;if(e||n.proto3Optional||t)return od;let s=xr("fieldPresence",{proto:n,parent:i});return s==Om&&(n.type==ua||n.type==ha)?od:s}function Av(n,e){if(n.label!=ud)return!1;switch(n.type){case rv:case ov:case ha:case ua:return!1}let t=n.options;return t&&gr(t,"packed")?t.packed:uv==xr("repeatedFieldEncoding",{proto:n,parent:e})}function Tv(n){let e=n.fields.find(i=>i.number===1),t=n.fields.find(i=>i.number===2);return Fi(e&&e.fieldKind=="scalar"&&e.scalar!=q.BYTES&&e.scalar!=q.FLOAT&&e.scalar!=q.DOUBLE&&t&&t.fieldKind!="list"&&t.fieldKind!="map"),{key:e,value:t}}function wv(n){var e;return dv==xr("enumType",{proto:n.proto,parent:(e=n.parent)!==null&&e!==void 0?e:n.file})}function km(n,e){return n.type==ha?!0:hv==xr("messageEncoding",{proto:n,parent:e})}function Rv(n,e){return fv==xr("utf8Validation",{proto:n,parent:e})}function xr(n,e){var t,i;let s=(t=e.proto.options)===null||t===void 0?void 0:t.features;if(s){let r=s[n];if(r!=0)return r}if("kind"in e){if(e.kind=="message")return xr(n,(i=e.parent)!==null&&i!==void 0?i:e.file);let r=Gm[e.edition];if(!r)throw new Error(`feature default for edition ${e.edition} not found`);return r[n]}return xr(n,e.parent)}function Fi(n,e){if(!n)throw new Error(e)}function Hm(n){let e=Cv(n);return e.messageType.forEach(ca),Il(e,()=>{}).getFile(e.name)}function Cv(n){return Object.assign(Object.create({syntax:"",edition:0}),Object.assign(Object.assign({$typeName:"google.protobuf.FileDescriptorProto",dependency:[],publicDependency:[],weakDependency:[],optionDependency:[],service:[],extension:[]},n),{messageType:n.messageType.map(Wm),enumType:n.enumType.map(Xm)}))}function Wm(n){var e,t,i,s,r,o,a,c;return Object.assign(Object.create({visibility:0}),{$typeName:"google.protobuf.DescriptorProto",name:n.name,field:(t=(e=n.field)===null||e===void 0?void 0:e.map(Iv))!==null&&t!==void 0?t:[],extension:[],nestedType:(s=(i=n.nestedType)===null||i===void 0?void 0:i.map(Wm))!==null&&s!==void 0?s:[],enumType:(o=(r=n.enumType)===null||r===void 0?void 0:r.map(Xm))!==null&&o!==void 0?o:[],extensionRange:(c=(a=n.extensionRange)===null||a===void 0?void 0:a.map(h=>Object.assign({$typeName:"google.protobuf.DescriptorProto.ExtensionRange"},h)))!==null&&c!==void 0?c:[],oneofDecl:[],reservedRange:[],reservedName:[]})}function Iv(n){return Object.assign(Object.create({label:1,typeName:"",extendee:"",defaultValue:"",oneofIndex:0,jsonName:"",proto3Optional:!1}),Object.assign(Object.assign({$typeName:"google.protobuf.FieldDescriptorProto"},n),{options:n.options?Nv(n.options):void 0}))}function Nv(n){var e,t,i;return Object.assign(Object.create({ctype:0,packed:!1,jstype:0,lazy:!1,unverifiedLazy:!1,deprecated:!1,weak:!1,debugRedact:!1,retention:0}),Object.assign(Object.assign({$typeName:"google.protobuf.FieldOptions"},n),{targets:(e=n.targets)!==null&&e!==void 0?e:[],editionDefaults:(i=(t=n.editionDefaults)===null||t===void 0?void 0:t.map(r=>Object.assign({$typeName:"google.protobuf.FieldOptions.EditionDefault"},r)))!==null&&i!==void 0?i:[],uninterpretedOption:[]}))}function Xm(n){return Object.assign(Object.create({visibility:0}),{$typeName:"google.protobuf.EnumDescriptorProto",name:n.name,reservedName:[],reservedRange:[],value:n.value.map(t=>Object.assign({$typeName:"google.protobuf.EnumValueDescriptorProto"},t))})}function Ui(n,e,...t){return t.reduce((i,s)=>i.nestedMessages[s],n.messages[e])}var Pv=Hm({name:"google/protobuf/descriptor.proto",package:"google.protobuf",messageType:[{name:"FileDescriptorSet",field:[{name:"file",number:1,type:11,label:3,typeName:".google.protobuf.FileDescriptorProto"}],extensionRange:[{start:536e6,end:536000001}]},{name:"FileDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"package",number:2,type:9,label:1},{name:"dependency",number:3,type:9,label:3},{name:"public_dependency",number:10,type:5,label:3},{name:"weak_dependency",number:11,type:5,label:3},{name:"option_dependency",number:15,type:9,label:3},{name:"message_type",number:4,type:11,label:3,typeName:".google.protobuf.DescriptorProto"},{name:"enum_type",number:5,type:11,label:3,typeName:".google.protobuf.EnumDescriptorProto"},{name:"service",number:6,type:11,label:3,typeName:".google.protobuf.ServiceDescriptorProto"},{name:"extension",number:7,type:11,label:3,typeName:".google.protobuf.FieldDescriptorProto"},{name:"options",number:8,type:11,label:1,typeName:".google.protobuf.FileOptions"},{name:"source_code_info",number:9,type:11,label:1,typeName:".google.protobuf.SourceCodeInfo"},{name:"syntax",number:12,type:9,label:1},{name:"edition",number:14,type:14,label:1,typeName:".google.protobuf.Edition"}]},{name:"DescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"field",number:2,type:11,label:3,typeName:".google.protobuf.FieldDescriptorProto"},{name:"extension",number:6,type:11,label:3,typeName:".google.protobuf.FieldDescriptorProto"},{name:"nested_type",number:3,type:11,label:3,typeName:".google.protobuf.DescriptorProto"},{name:"enum_type",number:4,type:11,label:3,typeName:".google.protobuf.EnumDescriptorProto"},{name:"extension_range",number:5,type:11,label:3,typeName:".google.protobuf.DescriptorProto.ExtensionRange"},{name:"oneof_decl",number:8,type:11,label:3,typeName:".google.protobuf.OneofDescriptorProto"},{name:"options",number:7,type:11,label:1,typeName:".google.protobuf.MessageOptions"},{name:"reserved_range",number:9,type:11,label:3,typeName:".google.protobuf.DescriptorProto.ReservedRange"},{name:"reserved_name",number:10,type:9,label:3},{name:"visibility",number:11,type:14,label:1,typeName:".google.protobuf.SymbolVisibility"}],nestedType:[{name:"ExtensionRange",field:[{name:"start",number:1,type:5,label:1},{name:"end",number:2,type:5,label:1},{name:"options",number:3,type:11,label:1,typeName:".google.protobuf.ExtensionRangeOptions"}]},{name:"ReservedRange",field:[{name:"start",number:1,type:5,label:1},{name:"end",number:2,type:5,label:1}]}]},{name:"ExtensionRangeOptions",field:[{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"},{name:"declaration",number:2,type:11,label:3,typeName:".google.protobuf.ExtensionRangeOptions.Declaration",options:{retention:2}},{name:"features",number:50,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"verification",number:3,type:14,label:1,typeName:".google.protobuf.ExtensionRangeOptions.VerificationState",defaultValue:"UNVERIFIED",options:{retention:2}}],nestedType:[{name:"Declaration",field:[{name:"number",number:1,type:5,label:1},{name:"full_name",number:2,type:9,label:1},{name:"type",number:3,type:9,label:1},{name:"reserved",number:5,type:8,label:1},{name:"repeated",number:6,type:8,label:1}]}],enumType:[{name:"VerificationState",value:[{name:"DECLARATION",number:0},{name:"UNVERIFIED",number:1}]}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"FieldDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"number",number:3,type:5,label:1},{name:"label",number:4,type:14,label:1,typeName:".google.protobuf.FieldDescriptorProto.Label"},{name:"type",number:5,type:14,label:1,typeName:".google.protobuf.FieldDescriptorProto.Type"},{name:"type_name",number:6,type:9,label:1},{name:"extendee",number:2,type:9,label:1},{name:"default_value",number:7,type:9,label:1},{name:"oneof_index",number:9,type:5,label:1},{name:"json_name",number:10,type:9,label:1},{name:"options",number:8,type:11,label:1,typeName:".google.protobuf.FieldOptions"},{name:"proto3_optional",number:17,type:8,label:1}],enumType:[{name:"Type",value:[{name:"TYPE_DOUBLE",number:1},{name:"TYPE_FLOAT",number:2},{name:"TYPE_INT64",number:3},{name:"TYPE_UINT64",number:4},{name:"TYPE_INT32",number:5},{name:"TYPE_FIXED64",number:6},{name:"TYPE_FIXED32",number:7},{name:"TYPE_BOOL",number:8},{name:"TYPE_STRING",number:9},{name:"TYPE_GROUP",number:10},{name:"TYPE_MESSAGE",number:11},{name:"TYPE_BYTES",number:12},{name:"TYPE_UINT32",number:13},{name:"TYPE_ENUM",number:14},{name:"TYPE_SFIXED32",number:15},{name:"TYPE_SFIXED64",number:16},{name:"TYPE_SINT32",number:17},{name:"TYPE_SINT64",number:18}]},{name:"Label",value:[{name:"LABEL_OPTIONAL",number:1},{name:"LABEL_REPEATED",number:3},{name:"LABEL_REQUIRED",number:2}]}]},{name:"OneofDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"options",number:2,type:11,label:1,typeName:".google.protobuf.OneofOptions"}]},{name:"EnumDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"value",number:2,type:11,label:3,typeName:".google.protobuf.EnumValueDescriptorProto"},{name:"options",number:3,type:11,label:1,typeName:".google.protobuf.EnumOptions"},{name:"reserved_range",number:4,type:11,label:3,typeName:".google.protobuf.EnumDescriptorProto.EnumReservedRange"},{name:"reserved_name",number:5,type:9,label:3},{name:"visibility",number:6,type:14,label:1,typeName:".google.protobuf.SymbolVisibility"}],nestedType:[{name:"EnumReservedRange",field:[{name:"start",number:1,type:5,label:1},{name:"end",number:2,type:5,label:1}]}]},{name:"EnumValueDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"number",number:2,type:5,label:1},{name:"options",number:3,type:11,label:1,typeName:".google.protobuf.EnumValueOptions"}]},{name:"ServiceDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"method",number:2,type:11,label:3,typeName:".google.protobuf.MethodDescriptorProto"},{name:"options",number:3,type:11,label:1,typeName:".google.protobuf.ServiceOptions"}]},{name:"MethodDescriptorProto",field:[{name:"name",number:1,type:9,label:1},{name:"input_type",number:2,type:9,label:1},{name:"output_type",number:3,type:9,label:1},{name:"options",number:4,type:11,label:1,typeName:".google.protobuf.MethodOptions"},{name:"client_streaming",number:5,type:8,label:1,defaultValue:"false"},{name:"server_streaming",number:6,type:8,label:1,defaultValue:"false"}]},{name:"FileOptions",field:[{name:"java_package",number:1,type:9,label:1},{name:"java_outer_classname",number:8,type:9,label:1},{name:"java_multiple_files",number:10,type:8,label:1,defaultValue:"false",options:{}},{name:"java_generate_equals_and_hash",number:20,type:8,label:1,options:{deprecated:!0}},{name:"java_string_check_utf8",number:27,type:8,label:1,defaultValue:"false"},{name:"optimize_for",number:9,type:14,label:1,typeName:".google.protobuf.FileOptions.OptimizeMode",defaultValue:"SPEED"},{name:"go_package",number:11,type:9,label:1},{name:"cc_generic_services",number:16,type:8,label:1,defaultValue:"false"},{name:"java_generic_services",number:17,type:8,label:1,defaultValue:"false"},{name:"py_generic_services",number:18,type:8,label:1,defaultValue:"false"},{name:"deprecated",number:23,type:8,label:1,defaultValue:"false"},{name:"cc_enable_arenas",number:31,type:8,label:1,defaultValue:"true",options:{}},{name:"objc_class_prefix",number:36,type:9,label:1},{name:"csharp_namespace",number:37,type:9,label:1},{name:"swift_prefix",number:39,type:9,label:1},{name:"php_class_prefix",number:40,type:9,label:1},{name:"php_namespace",number:41,type:9,label:1},{name:"php_metadata_namespace",number:44,type:9,label:1},{name:"ruby_package",number:45,type:9,label:1},{name:"features",number:50,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],enumType:[{name:"OptimizeMode",value:[{name:"SPEED",number:1},{name:"CODE_SIZE",number:2},{name:"LITE_RUNTIME",number:3}]}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"MessageOptions",field:[{name:"message_set_wire_format",number:1,type:8,label:1,defaultValue:"false"},{name:"no_standard_descriptor_accessor",number:2,type:8,label:1,defaultValue:"false"},{name:"deprecated",number:3,type:8,label:1,defaultValue:"false"},{name:"map_entry",number:7,type:8,label:1},{name:"deprecated_legacy_json_field_conflicts",number:11,type:8,label:1,options:{deprecated:!0}},{name:"features",number:12,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"FieldOptions",field:[{name:"ctype",number:1,type:14,label:1,typeName:".google.protobuf.FieldOptions.CType",defaultValue:"STRING"},{name:"packed",number:2,type:8,label:1},{name:"jstype",number:6,type:14,label:1,typeName:".google.protobuf.FieldOptions.JSType",defaultValue:"JS_NORMAL"},{name:"lazy",number:5,type:8,label:1,defaultValue:"false"},{name:"unverified_lazy",number:15,type:8,label:1,defaultValue:"false"},{name:"deprecated",number:3,type:8,label:1,defaultValue:"false"},{name:"weak",number:10,type:8,label:1,defaultValue:"false",options:{deprecated:!0}},{name:"debug_redact",number:16,type:8,label:1,defaultValue:"false"},{name:"retention",number:17,type:14,label:1,typeName:".google.protobuf.FieldOptions.OptionRetention"},{name:"targets",number:19,type:14,label:3,typeName:".google.protobuf.FieldOptions.OptionTargetType"},{name:"edition_defaults",number:20,type:11,label:3,typeName:".google.protobuf.FieldOptions.EditionDefault"},{name:"features",number:21,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"feature_support",number:22,type:11,label:1,typeName:".google.protobuf.FieldOptions.FeatureSupport"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],nestedType:[{name:"EditionDefault",field:[{name:"edition",number:3,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"value",number:2,type:9,label:1}]},{name:"FeatureSupport",field:[{name:"edition_introduced",number:1,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"edition_deprecated",number:2,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"deprecation_warning",number:3,type:9,label:1},{name:"edition_removed",number:4,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"removal_error",number:5,type:9,label:1}]}],enumType:[{name:"CType",value:[{name:"STRING",number:0},{name:"CORD",number:1},{name:"STRING_PIECE",number:2}]},{name:"JSType",value:[{name:"JS_NORMAL",number:0},{name:"JS_STRING",number:1},{name:"JS_NUMBER",number:2}]},{name:"OptionRetention",value:[{name:"RETENTION_UNKNOWN",number:0},{name:"RETENTION_RUNTIME",number:1},{name:"RETENTION_SOURCE",number:2}]},{name:"OptionTargetType",value:[{name:"TARGET_TYPE_UNKNOWN",number:0},{name:"TARGET_TYPE_FILE",number:1},{name:"TARGET_TYPE_EXTENSION_RANGE",number:2},{name:"TARGET_TYPE_MESSAGE",number:3},{name:"TARGET_TYPE_FIELD",number:4},{name:"TARGET_TYPE_ONEOF",number:5},{name:"TARGET_TYPE_ENUM",number:6},{name:"TARGET_TYPE_ENUM_ENTRY",number:7},{name:"TARGET_TYPE_SERVICE",number:8},{name:"TARGET_TYPE_METHOD",number:9}]}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"OneofOptions",field:[{name:"features",number:1,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"EnumOptions",field:[{name:"allow_alias",number:2,type:8,label:1},{name:"deprecated",number:3,type:8,label:1,defaultValue:"false"},{name:"deprecated_legacy_json_field_conflicts",number:6,type:8,label:1,options:{deprecated:!0}},{name:"features",number:7,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"EnumValueOptions",field:[{name:"deprecated",number:1,type:8,label:1,defaultValue:"false"},{name:"features",number:2,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"debug_redact",number:3,type:8,label:1,defaultValue:"false"},{name:"feature_support",number:4,type:11,label:1,typeName:".google.protobuf.FieldOptions.FeatureSupport"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"ServiceOptions",field:[{name:"features",number:34,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"deprecated",number:33,type:8,label:1,defaultValue:"false"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"MethodOptions",field:[{name:"deprecated",number:33,type:8,label:1,defaultValue:"false"},{name:"idempotency_level",number:34,type:14,label:1,typeName:".google.protobuf.MethodOptions.IdempotencyLevel",defaultValue:"IDEMPOTENCY_UNKNOWN"},{name:"features",number:35,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"uninterpreted_option",number:999,type:11,label:3,typeName:".google.protobuf.UninterpretedOption"}],enumType:[{name:"IdempotencyLevel",value:[{name:"IDEMPOTENCY_UNKNOWN",number:0},{name:"NO_SIDE_EFFECTS",number:1},{name:"IDEMPOTENT",number:2}]}],extensionRange:[{start:990,end:999},{start:1e3,end:536870912}]},{name:"UninterpretedOption",field:[{name:"name",number:2,type:11,label:3,typeName:".google.protobuf.UninterpretedOption.NamePart"},{name:"identifier_value",number:3,type:9,label:1},{name:"positive_int_value",number:4,type:4,label:1},{name:"negative_int_value",number:5,type:3,label:1},{name:"double_value",number:6,type:1,label:1},{name:"string_value",number:7,type:12,label:1},{name:"aggregate_value",number:8,type:9,label:1}],nestedType:[{name:"NamePart",field:[{name:"name_part",number:1,type:9,label:2},{name:"is_extension",number:2,type:8,label:2}]}]},{name:"FeatureSet",field:[{name:"field_presence",number:1,type:14,label:1,typeName:".google.protobuf.FeatureSet.FieldPresence",options:{retention:1,targets:[4,1],editionDefaults:[{value:"EXPLICIT",edition:900},{value:"IMPLICIT",edition:999},{value:"EXPLICIT",edition:1e3}]}},{name:"enum_type",number:2,type:14,label:1,typeName:".google.protobuf.FeatureSet.EnumType",options:{retention:1,targets:[6,1],editionDefaults:[{value:"CLOSED",edition:900},{value:"OPEN",edition:999}]}},{name:"repeated_field_encoding",number:3,type:14,label:1,typeName:".google.protobuf.FeatureSet.RepeatedFieldEncoding",options:{retention:1,targets:[4,1],editionDefaults:[{value:"EXPANDED",edition:900},{value:"PACKED",edition:999}]}},{name:"utf8_validation",number:4,type:14,label:1,typeName:".google.protobuf.FeatureSet.Utf8Validation",options:{retention:1,targets:[4,1],editionDefaults:[{value:"NONE",edition:900},{value:"VERIFY",edition:999}]}},{name:"message_encoding",number:5,type:14,label:1,typeName:".google.protobuf.FeatureSet.MessageEncoding",options:{retention:1,targets:[4,1],editionDefaults:[{value:"LENGTH_PREFIXED",edition:900}]}},{name:"json_format",number:6,type:14,label:1,typeName:".google.protobuf.FeatureSet.JsonFormat",options:{retention:1,targets:[3,6,1],editionDefaults:[{value:"LEGACY_BEST_EFFORT",edition:900},{value:"ALLOW",edition:999}]}},{name:"enforce_naming_style",number:7,type:14,label:1,typeName:".google.protobuf.FeatureSet.EnforceNamingStyle",options:{retention:2,targets:[1,2,3,4,5,6,7,8,9],editionDefaults:[{value:"STYLE_LEGACY",edition:900},{value:"STYLE2024",edition:1001},{value:"STYLE2026",edition:1002}]}},{name:"default_symbol_visibility",number:8,type:14,label:1,typeName:".google.protobuf.FeatureSet.VisibilityFeature.DefaultSymbolVisibility",options:{retention:2,targets:[1],editionDefaults:[{value:"EXPORT_ALL",edition:900},{value:"EXPORT_TOP_LEVEL",edition:1001},{value:"STRICT",edition:1002}]}},{name:"enforce_proto_limits",number:9,type:14,label:1,typeName:".google.protobuf.FeatureSet.ProtoLimitsFeature.EnforceProtoLimits",options:{retention:2,targets:[6,3,4,5],editionDefaults:[{value:"LEGACY_NO_EXPLICIT_LIMITS",edition:900},{value:"PROTO_LIMITS2026",edition:1002}]}}],nestedType:[{name:"VisibilityFeature",enumType:[{name:"DefaultSymbolVisibility",value:[{name:"DEFAULT_SYMBOL_VISIBILITY_UNKNOWN",number:0},{name:"EXPORT_ALL",number:1},{name:"EXPORT_TOP_LEVEL",number:2},{name:"LOCAL_ALL",number:3},{name:"STRICT",number:4}]}]},{name:"ProtoLimitsFeature",enumType:[{name:"EnforceProtoLimits",value:[{name:"PROTO_LIMITS_UNKNOWN",number:0},{name:"LEGACY_NO_EXPLICIT_LIMITS",number:1},{name:"PROTO_LIMITS2026",number:2}]}]}],enumType:[{name:"FieldPresence",value:[{name:"FIELD_PRESENCE_UNKNOWN",number:0},{name:"EXPLICIT",number:1},{name:"IMPLICIT",number:2},{name:"LEGACY_REQUIRED",number:3}]},{name:"EnumType",value:[{name:"ENUM_TYPE_UNKNOWN",number:0},{name:"OPEN",number:1},{name:"CLOSED",number:2}]},{name:"RepeatedFieldEncoding",value:[{name:"REPEATED_FIELD_ENCODING_UNKNOWN",number:0},{name:"PACKED",number:1},{name:"EXPANDED",number:2}]},{name:"Utf8Validation",value:[{name:"UTF8_VALIDATION_UNKNOWN",number:0},{name:"VERIFY",number:2},{name:"NONE",number:3}]},{name:"MessageEncoding",value:[{name:"MESSAGE_ENCODING_UNKNOWN",number:0},{name:"LENGTH_PREFIXED",number:1},{name:"DELIMITED",number:2}]},{name:"JsonFormat",value:[{name:"JSON_FORMAT_UNKNOWN",number:0},{name:"ALLOW",number:1},{name:"LEGACY_BEST_EFFORT",number:2}]},{name:"EnforceNamingStyle",value:[{name:"ENFORCE_NAMING_STYLE_UNKNOWN",number:0},{name:"STYLE2024",number:1},{name:"STYLE_LEGACY",number:2},{name:"STYLE2026",number:3}]}],extensionRange:[{start:1e3,end:9995},{start:9995,end:1e4},{start:1e4,end:10001}]},{name:"FeatureSetDefaults",field:[{name:"defaults",number:1,type:11,label:3,typeName:".google.protobuf.FeatureSetDefaults.FeatureSetEditionDefault"},{name:"minimum_edition",number:4,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"maximum_edition",number:5,type:14,label:1,typeName:".google.protobuf.Edition"}],nestedType:[{name:"FeatureSetEditionDefault",field:[{name:"edition",number:3,type:14,label:1,typeName:".google.protobuf.Edition"},{name:"overridable_features",number:4,type:11,label:1,typeName:".google.protobuf.FeatureSet"},{name:"fixed_features",number:5,type:11,label:1,typeName:".google.protobuf.FeatureSet"}]}]},{name:"SourceCodeInfo",field:[{name:"location",number:1,type:11,label:3,typeName:".google.protobuf.SourceCodeInfo.Location"}],nestedType:[{name:"Location",field:[{name:"path",number:1,type:5,label:3,options:{packed:!0}},{name:"span",number:2,type:5,label:3,options:{packed:!0}},{name:"leading_comments",number:3,type:9,label:1},{name:"trailing_comments",number:4,type:9,label:1},{name:"leading_detached_comments",number:6,type:9,label:3}]}],extensionRange:[{start:536e6,end:536000001}]},{name:"GeneratedCodeInfo",field:[{name:"annotation",number:1,type:11,label:3,typeName:".google.protobuf.GeneratedCodeInfo.Annotation"}],nestedType:[{name:"Annotation",field:[{name:"path",number:1,type:5,label:3,options:{packed:!0}},{name:"source_file",number:2,type:9,label:1},{name:"begin",number:3,type:5,label:1},{name:"end",number:4,type:5,label:1},{name:"semantic",number:5,type:14,label:1,typeName:".google.protobuf.GeneratedCodeInfo.Annotation.Semantic"}],enumType:[{name:"Semantic",value:[{name:"NONE",number:0},{name:"SET",number:1},{name:"ALIAS",number:2}]}]}]}],enumType:[{name:"Edition",value:[{name:"EDITION_UNKNOWN",number:0},{name:"EDITION_LEGACY",number:900},{name:"EDITION_PROTO2",number:998},{name:"EDITION_PROTO3",number:999},{name:"EDITION_2023",number:1e3},{name:"EDITION_2024",number:1001},{name:"EDITION_2026",number:1002},{name:"EDITION_UNSTABLE",number:9999},{name:"EDITION_1_TEST_ONLY",number:1},{name:"EDITION_2_TEST_ONLY",number:2},{name:"EDITION_99997_TEST_ONLY",number:99997},{name:"EDITION_99998_TEST_ONLY",number:99998},{name:"EDITION_99999_TEST_ONLY",number:99999},{name:"EDITION_MAX",number:2147483647}]},{name:"SymbolVisibility",value:[{name:"VISIBILITY_UNSET",number:0},{name:"VISIBILITY_LOCAL",number:1},{name:"VISIBILITY_EXPORT",number:2}]}]});var fg=Ui(Pv,1);var Ym;(function(n){n[n.DECLARATION=0]="DECLARATION",n[n.UNVERIFIED=1]="UNVERIFIED"})(Ym||(Ym={}));var Zm;(function(n){n[n.DOUBLE=1]="DOUBLE",n[n.FLOAT=2]="FLOAT",n[n.INT64=3]="INT64",n[n.UINT64=4]="UINT64",n[n.INT32=5]="INT32",n[n.FIXED64=6]="FIXED64",n[n.FIXED32=7]="FIXED32",n[n.BOOL=8]="BOOL",n[n.STRING=9]="STRING",n[n.GROUP=10]="GROUP",n[n.MESSAGE=11]="MESSAGE",n[n.BYTES=12]="BYTES",n[n.UINT32=13]="UINT32",n[n.ENUM=14]="ENUM",n[n.SFIXED32=15]="SFIXED32",n[n.SFIXED64=16]="SFIXED64",n[n.SINT32=17]="SINT32",n[n.SINT64=18]="SINT64"})(Zm||(Zm={}));var Km;(function(n){n[n.OPTIONAL=1]="OPTIONAL",n[n.REPEATED=3]="REPEATED",n[n.REQUIRED=2]="REQUIRED"})(Km||(Km={}));var $m;(function(n){n[n.SPEED=1]="SPEED",n[n.CODE_SIZE=2]="CODE_SIZE",n[n.LITE_RUNTIME=3]="LITE_RUNTIME"})($m||($m={}));var qm;(function(n){n[n.STRING=0]="STRING",n[n.CORD=1]="CORD",n[n.STRING_PIECE=2]="STRING_PIECE"})(qm||(qm={}));var Jm;(function(n){n[n.JS_NORMAL=0]="JS_NORMAL",n[n.JS_STRING=1]="JS_STRING",n[n.JS_NUMBER=2]="JS_NUMBER"})(Jm||(Jm={}));var jm;(function(n){n[n.RETENTION_UNKNOWN=0]="RETENTION_UNKNOWN",n[n.RETENTION_RUNTIME=1]="RETENTION_RUNTIME",n[n.RETENTION_SOURCE=2]="RETENTION_SOURCE"})(jm||(jm={}));var Qm;(function(n){n[n.TARGET_TYPE_UNKNOWN=0]="TARGET_TYPE_UNKNOWN",n[n.TARGET_TYPE_FILE=1]="TARGET_TYPE_FILE",n[n.TARGET_TYPE_EXTENSION_RANGE=2]="TARGET_TYPE_EXTENSION_RANGE",n[n.TARGET_TYPE_MESSAGE=3]="TARGET_TYPE_MESSAGE",n[n.TARGET_TYPE_FIELD=4]="TARGET_TYPE_FIELD",n[n.TARGET_TYPE_ONEOF=5]="TARGET_TYPE_ONEOF",n[n.TARGET_TYPE_ENUM=6]="TARGET_TYPE_ENUM",n[n.TARGET_TYPE_ENUM_ENTRY=7]="TARGET_TYPE_ENUM_ENTRY",n[n.TARGET_TYPE_SERVICE=8]="TARGET_TYPE_SERVICE",n[n.TARGET_TYPE_METHOD=9]="TARGET_TYPE_METHOD"})(Qm||(Qm={}));var eg;(function(n){n[n.IDEMPOTENCY_UNKNOWN=0]="IDEMPOTENCY_UNKNOWN",n[n.NO_SIDE_EFFECTS=1]="NO_SIDE_EFFECTS",n[n.IDEMPOTENT=2]="IDEMPOTENT"})(eg||(eg={}));var tg;(function(n){n[n.DEFAULT_SYMBOL_VISIBILITY_UNKNOWN=0]="DEFAULT_SYMBOL_VISIBILITY_UNKNOWN",n[n.EXPORT_ALL=1]="EXPORT_ALL",n[n.EXPORT_TOP_LEVEL=2]="EXPORT_TOP_LEVEL",n[n.LOCAL_ALL=3]="LOCAL_ALL",n[n.STRICT=4]="STRICT"})(tg||(tg={}));var ng;(function(n){n[n.PROTO_LIMITS_UNKNOWN=0]="PROTO_LIMITS_UNKNOWN",n[n.LEGACY_NO_EXPLICIT_LIMITS=1]="LEGACY_NO_EXPLICIT_LIMITS",n[n.PROTO_LIMITS2026=2]="PROTO_LIMITS2026"})(ng||(ng={}));var ig;(function(n){n[n.FIELD_PRESENCE_UNKNOWN=0]="FIELD_PRESENCE_UNKNOWN",n[n.EXPLICIT=1]="EXPLICIT",n[n.IMPLICIT=2]="IMPLICIT",n[n.LEGACY_REQUIRED=3]="LEGACY_REQUIRED"})(ig||(ig={}));var sg;(function(n){n[n.ENUM_TYPE_UNKNOWN=0]="ENUM_TYPE_UNKNOWN",n[n.OPEN=1]="OPEN",n[n.CLOSED=2]="CLOSED"})(sg||(sg={}));var rg;(function(n){n[n.REPEATED_FIELD_ENCODING_UNKNOWN=0]="REPEATED_FIELD_ENCODING_UNKNOWN",n[n.PACKED=1]="PACKED",n[n.EXPANDED=2]="EXPANDED"})(rg||(rg={}));var og;(function(n){n[n.UTF8_VALIDATION_UNKNOWN=0]="UTF8_VALIDATION_UNKNOWN",n[n.VERIFY=2]="VERIFY",n[n.NONE=3]="NONE"})(og||(og={}));var ag;(function(n){n[n.MESSAGE_ENCODING_UNKNOWN=0]="MESSAGE_ENCODING_UNKNOWN",n[n.LENGTH_PREFIXED=1]="LENGTH_PREFIXED",n[n.DELIMITED=2]="DELIMITED"})(ag||(ag={}));var lg;(function(n){n[n.JSON_FORMAT_UNKNOWN=0]="JSON_FORMAT_UNKNOWN",n[n.ALLOW=1]="ALLOW",n[n.LEGACY_BEST_EFFORT=2]="LEGACY_BEST_EFFORT"})(lg||(lg={}));var cg;(function(n){n[n.ENFORCE_NAMING_STYLE_UNKNOWN=0]="ENFORCE_NAMING_STYLE_UNKNOWN",n[n.STYLE2024=1]="STYLE2024",n[n.STYLE_LEGACY=2]="STYLE_LEGACY",n[n.STYLE2026=3]="STYLE2026"})(cg||(cg={}));var ug;(function(n){n[n.NONE=0]="NONE",n[n.SET=1]="SET",n[n.ALIAS=2]="ALIAS"})(ug||(ug={}));var hg;(function(n){n[n.EDITION_UNKNOWN=0]="EDITION_UNKNOWN",n[n.EDITION_LEGACY=900]="EDITION_LEGACY",n[n.EDITION_PROTO2=998]="EDITION_PROTO2",n[n.EDITION_PROTO3=999]="EDITION_PROTO3",n[n.EDITION_2023=1e3]="EDITION_2023",n[n.EDITION_2024=1001]="EDITION_2024",n[n.EDITION_2026=1002]="EDITION_2026",n[n.EDITION_UNSTABLE=9999]="EDITION_UNSTABLE",n[n.EDITION_1_TEST_ONLY=1]="EDITION_1_TEST_ONLY",n[n.EDITION_2_TEST_ONLY=2]="EDITION_2_TEST_ONLY",n[n.EDITION_99997_TEST_ONLY=99997]="EDITION_99997_TEST_ONLY",n[n.EDITION_99998_TEST_ONLY=99998]="EDITION_99998_TEST_ONLY",n[n.EDITION_99999_TEST_ONLY=99999]="EDITION_99999_TEST_ONLY",n[n.EDITION_MAX=2147483647]="EDITION_MAX"})(hg||(hg={}));var dg;(function(n){n[n.VISIBILITY_UNSET=0]="VISIBILITY_UNSET",n[n.VISIBILITY_LOCAL=1]="VISIBILITY_LOCAL",n[n.VISIBILITY_EXPORT=2]="VISIBILITY_EXPORT"})(dg||(dg={}));function Lv(n){return Object.assign(Object.assign({readUnknownFields:!0,recursionLimit:100},n),{depth:0})}function da(n,e,t){let i=sn(n);return hd(n).read(i,new yr(e),Lv(t),e.byteLength),i}var pg=new WeakMap;function hd(n){let e=pg.get(n);return e===void 0&&(e=Dv(n)),e}function Dv(n){let e=String(n),t=new Map,i={read:Fv(e,t),readGroup:Uv(e,t)};pg.set(n,i);for(let s of n.fields)t.set(s.number,Ov(s));return i}function Fv(n,e){return(t,i,s,r)=>{var o;if(++s.depth>s.recursionLimit)throw new Error(`cannot decode ${n} from binary: maximum recursion depth of ${s.recursionLimit} reached`);let a=i.pos+r,c=(o=t.$unknown)!==null&&o!==void 0?o:[];for(;i.pos<a;){let[l,h]=i.tag(),u=e.get(l);if(u===void 0){let d=i.skip(h,l,s.recursionLimit-s.depth);s.readUnknownFields&&c.push({no:l,wireType:h,data:d});continue}u(t,i,s,h)}c.length>0&&(t.$unknown=c),s.depth--}}function Uv(n,e){return(t,i,s,r)=>{var o;if(++s.depth>s.recursionLimit)throw new Error(`cannot decode ${n} from binary: maximum recursion depth of ${s.recursionLimit} reached`);let a,c,l=(o=t.$unknown)!==null&&o!==void 0?o:[];for(;i.pos<i.len&&([a,c]=i.tag(),c!=Ot.EndGroup);){let h=e.get(a);if(h===void 0){let u=i.skip(c,a,s.recursionLimit-s.depth);s.readUnknownFields&&l.push({no:a,wireType:c,data:u});continue}h(t,i,s,c)}if(c!=Ot.EndGroup||a!==r)throw new Error("invalid end group tag");l.length>0&&(t.$unknown=l),s.depth--}}function Ov(n){switch(n.fieldKind){case"scalar":return Bv(n);case"enum":return kv(n);case"message":return Gv(n);case"list":return Vv(n);case"map":return zv(n)}}function Bv(n){let e=Pl(n.scalar,n.utf8Validation,n.longAsString),t=n.localName;if(n.oneof){let i=n.oneof.localName;return(s,r)=>{s[i]={case:t,value:e(r)}}}return(i,s)=>{i[t]=e(s)}}function kv(n){var e;let t=n.localName,i=(e=n.oneof)===null||e===void 0?void 0:e.localName;if(n.enum.open)return i!==void 0?(o,a)=>{o[i]={case:t,value:a.int32()}}:(o,a)=>{o[t]=a.int32()};let s=n.enum.values,r=n.number;return(o,a,c,l)=>{var h;let u=a.int32();if(s.some(d=>d.number===u))i!==void 0?o[i]={case:t,value:u}:o[t]=u;else if(c.readUnknownFields){let d=[];$p(u,d);let f=(h=o.$unknown)!==null&&h!==void 0?h:[];f.push({no:r,wireType:l,data:new Uint8Array(d)}),o.$unknown=f}}}function Gv(n){let e=n.localName,{toMessage:t,toLocal:i}=Ws(n),s=mg(n);if(n.oneof){let r=n.oneof.localName;return(o,a,c)=>{let l=o[r],h=t(l.case===e?l.value:void 0);s(h,a,c),o[r]={case:e,value:i(h)}}}return(r,o,a)=>{let c=t(r[e]);s(c,o,a),r[e]=i(c)}}function mg(n){let e=hd(n.message);if(n.delimitedEncoding){let t=n.number;return(i,s,r)=>e.readGroup(i,s,r,t)}return(t,i,s)=>e.read(t,i,s,i.uint32())}function Vv(n){let e=n.localName;if(n.listKind=="message"){let{toMessage:o,toLocal:a}=Ws(n),c=mg(n);return(l,h,u)=>{let d=o(void 0);c(d,h,u),l[e].push(a(d))}}let t=n.listKind=="enum"?q.INT32:n.scalar,i=n.listKind=="scalar"?n.longAsString:!1,s=Pl(t,n.utf8Validation,i),r=t!=q.STRING&&t!=q.BYTES;return(o,a,c,l)=>{let h=o[e];if(l==Ot.LengthDelimited&&r){let u=a.uint32()+a.pos;for(;a.pos<u;)h.push(s(a))}else h.push(s(a))}}function zv(n){let e=n.localName,t=Pl(n.mapKey,n.utf8Validation,!1),i=ms(n.mapKey,!1),s,r;switch(n.mapKind){case"scalar":{let o=n.scalar,a=Pl(o,n.utf8Validation,!1);if(s=c=>a(c),o==q.BYTES)r=()=>new Uint8Array(0);else{let c=ms(o,!1);r=()=>c}break}case"enum":{let o=n.enum.values[0].number;s=a=>a.int32(),r=()=>o;break}case"message":{let{toMessage:o,toLocal:a}=Ws(n),c=hd(n.message).read;s=(l,h,u)=>{let d=o(u);return c(d,l,h,l.uint32()),a(d)},r=()=>a(o(void 0));break}}return(o,a,c)=>{let l=o[e],h,u,d=a.uint32(),f=a.pos+d;for(;a.pos<f;){let[g,v]=a.tag();switch(g){case 1:h=t(a);break;case 2:u=s(a,c,u);break;default:a.skip(v,g,c.recursionLimit-c.depth)}}h===void 0&&(h=i),u===void 0&&(u=r()),gs(l,h,u)}}function Pl(n,e,t){switch(n){case q.STRING:return i=>i.string(e);case q.BOOL:return i=>i.bool();case q.DOUBLE:return i=>i.double();case q.FLOAT:return i=>i.float();case q.INT32:return i=>i.int32();case q.INT64:return t?i=>String(i.int64()):i=>i.int64();case q.UINT64:return t?i=>String(i.uint64()):i=>i.uint64();case q.FIXED64:return t?i=>String(i.fixed64()):i=>i.fixed64();case q.BYTES:return i=>i.bytes();case q.FIXED32:return i=>i.fixed32();case q.SFIXED32:return i=>i.sfixed32();case q.SFIXED64:return t?i=>String(i.sfixed64()):i=>i.sfixed64();case q.SINT64:return t?i=>String(i.sint64()):i=>i.sint64();case q.UINT32:return i=>i.uint32();case q.SINT32:return i=>i.sint32()}}function Ll(n,e){var t;let i=da(fg,Pm(n));return i.messageType.forEach(ca),i.dependency=(t=e?.map(r=>r.proto.name))!==null&&t!==void 0?t:[],Il(i,r=>e?.find(o=>o.proto.name===r)).getFile(i.name)}var Hv=2,Wv=3,gg={writeUnknownFields:!0};function Xv(n){return n?Object.assign(Object.assign({},gg),n):gg}function dd(n,e,t){let i=new bl;return fd(n)(i,Xv(t),e),i.finish()}var _g=new WeakMap;function fd(n){let e=_g.get(n);return e===void 0&&(e=Yv(n)),e}function Yv(n){let e=n.typeName,t=n.fields.concat().sort((o,a)=>o.number-a.number),i=t[0],s=[],r=(o,a,c)=>{if(c.$typeName!==e&&i!==void 0)throw new Si(i,`cannot use ${i} with message ${c.$typeName}`,"ForeignFieldError");for(let h=0;h<s.length;h++)s[h](o,a,c);let l=c.$unknown;if(l!==void 0&&a.writeUnknownFields)for(let h=0;h<l.length;h++){let{no:u,wireType:d,data:f}=l[h];o.tag(u,d).raw(f)}};_g.set(n,r);for(let o of t)s.push(Zv(o));return r}function Zv(n){switch(n.fieldKind){case"message":case"scalar":case"enum":return Kv(n);case"list":return qv(n);case"map":return Jv(n)}}function Kv(n){let e=$v(n),t=n.localName;if(n.oneof){let i=n.oneof.localName;return(s,r,o)=>{let a=o[i];a.case===t&&e(s,r,a.value)}}if(n.presence!=Hv){let i=n.presence==Wv?`cannot encode ${n} to binary: required field not set`:void 0;return(s,r,o)=>{let a=o[t];if(a!==void 0&&Object.prototype.hasOwnProperty.call(o,t))e(s,r,a);else if(i!==void 0)throw new Error(i)}}if(n.fieldKind=="enum"){let i=n.enum.values[0].number;return(s,r,o)=>{let a=o[t];a!==i&&e(s,r,a)}}switch(n.scalar){case q.BOOL:return(i,s,r)=>{let o=r[t];o!==!1&&e(i,s,o)};case q.STRING:return(i,s,r)=>{let o=r[t];o!==""&&e(i,s,o)};case q.BYTES:return(i,s,r)=>{let o=r[t];(!(o instanceof Uint8Array)||o.byteLength>0)&&e(i,s,o)};case q.DOUBLE:case q.FLOAT:return(i,s,r)=>{let o=r[t];Object.is(o,0)||e(i,s,o)};default:return(i,s,r)=>{let o=r[t];o!=0&&e(i,s,o)}}}function $v(n){switch(n.fieldKind){case"message":{let{toMessage:e}=Ws(n),t=yg(n);return(i,s,r)=>{t(i,s,e(r))}}case"scalar":case"enum":{let e=n.fieldKind=="enum"?q.INT32:n.scalar,t=n.number,i=Fl(e),s=Dl(e,n.parent.typeName,n.name);return(r,o,a)=>{r.tag(t,i),s(r,a)}}}}function qv(n){let e=n.localName,t=n.number;switch(n.listKind){case"message":{let{toMessage:i}=Ws(n),s=yg(n);return(r,o,a)=>{let c=a[e];for(let l=0;l<c.length;l++)s(r,o,i(c[l]))}}case"scalar":case"enum":{let i=n.listKind=="enum"?q.INT32:n.scalar,s=Dl(i,n.parent.typeName,n.name);if(n.packed)return(o,a,c)=>{let l=c[e];if(l.length!=0){o.tag(t,Ot.LengthDelimited).fork();for(let h=0;h<l.length;h++)s(o,l[h]);o.join()}};let r=Fl(i);return(o,a,c)=>{let l=c[e];for(let h=0;h<l.length;h++)o.tag(t,r),s(o,l[h])}}}}function Jv(n){let e=n.localName,t=n.number,i=jv(n);if(n.mapKind=="message"){let{toMessage:a}=Ws(n),c=fd(n.message);return(l,h,u)=>{let d=u[e],f=Object.keys(d);for(let g=0;g<f.length;g++){let v=f[g];l.tag(t,Ot.LengthDelimited).fork(),i(l,v),l.tag(2,Ot.LengthDelimited).fork(),c(l,h,a(d[v])),l.join(),l.join()}}}let s=n.mapKind=="enum"?q.INT32:n.scalar,r=Fl(s),o=Dl(s,n.parent.typeName,n.name);return(a,c,l)=>{let h=l[e],u=Object.keys(h);for(let d=0;d<u.length;d++){let f=u[d];a.tag(t,Ot.LengthDelimited).fork(),i(a,f),a.tag(2,r),o(a,h[f]),a.join()}}}function jv(n){let e=Fl(n.mapKey),t=Dl(n.mapKey,n.parent.typeName,n.name),i=Qv(n.mapKey);return(s,r)=>{s.tag(1,e),t(s,i(r))}}function Qv(n){switch(n){case q.STRING:return e=>e;case q.BOOL:return e=>e==="true"?!0:e==="false"?!1:e;case q.UINT64:case q.FIXED64:return e=>{try{return Tt.uParse(e)}catch{return e}};case q.INT64:case q.SFIXED64:case q.SINT64:return e=>{try{return Tt.parse(e)}catch{return e}};default:return e=>{let t=Number.parseInt(e);return Number.isFinite(t)?t:e}}}function Dl(n,e,t){let i=eb(n);return(s,r)=>{try{i(s,r)}catch(o){throw o instanceof Error?new Error(`cannot encode field ${e}.${t} to binary: ${o.message}`):o}}}function eb(n){switch(n){case q.STRING:return(e,t)=>e.string(t);case q.BOOL:return(e,t)=>e.bool(t);case q.DOUBLE:return(e,t)=>e.double(t);case q.FLOAT:return(e,t)=>e.float(t);case q.INT32:return(e,t)=>e.int32(t);case q.INT64:return(e,t)=>e.int64(t);case q.UINT64:return(e,t)=>e.uint64(t);case q.FIXED64:return(e,t)=>e.fixed64(t);case q.BYTES:return(e,t)=>e.bytes(t);case q.FIXED32:return(e,t)=>e.fixed32(t);case q.SFIXED32:return(e,t)=>e.sfixed32(t);case q.SFIXED64:return(e,t)=>e.sfixed64(t);case q.SINT64:return(e,t)=>e.sint64(t);case q.UINT32:return(e,t)=>e.uint32(t);case q.SINT32:return(e,t)=>e.sint32(t)}}function yg(n){let e=n.number,t=fd(n.message);return n.delimitedEncoding?(i,s,r)=>{i.tag(e,Ot.StartGroup),t(i,s,r),i.tag(e,Ot.EndGroup)}:(i,s,r)=>{i.tag(e,Ot.LengthDelimited).fork(),t(i,s,r),i.join()}}function Fl(n){switch(n){case q.BYTES:case q.STRING:return Ot.LengthDelimited;case q.DOUBLE:case q.FIXED64:case q.SFIXED64:return Ot.Bit64;case q.FIXED32:case q.SFIXED32:case q.FLOAT:return Ot.Bit32;default:return Ot.Varint}}var fa=Ll("Cg9tZWFzdXJpbmcucHJvdG8SEmlzb3RoZXJtLm1lYXN1cmluZyIqCgdWZWN0b3IzEgkKAXgYASABKAESCQoBeRgCIAEoARIJCgF6GAMgASgBImUKBkFuY2hvchIrCgZvcmlnaW4YASABKAsyGy5pc290aGVybS5tZWFzdXJpbmcuVmVjdG9yMxIuCglkaXJlY3Rpb24YAiABKAsyGy5pc290aGVybS5tZWFzdXJpbmcuVmVjdG9yMyL+AQoQT2JqZWN0UGFyYW1ldGVycxIXCgplbWlzc2l2aXR5GAEgASgBSACIAQESHgoRcmVmbGVjdGVkX2NlbHNpdXMYAiABKAFIAYgBARIVCghtYXRlcmlhbBgDIAEoCUgCiAEBEhgKC2Fpcl9jZWxzaXVzGAQgASgBSAOIAQESIwoWZmlsbV9jb2VmZmljaWVudF93X20yaxgFIAEoAUgEiAEBQg0KC19lbWlzc2l2aXR5QhQKEl9yZWZsZWN0ZWRfY2Vsc2l1c0ILCglfbWF0ZXJpYWxCDgoMX2Fpcl9jZWxzaXVzQhkKF19maWxtX2NvZWZmaWNpZW50X3dfbTJrIrgDCgVTaGFwZRIKCgJpZBgBIAEoCRIMCgRuYW1lGAIgASgJEiwKBGtpbmQYAyABKA4yHi5pc290aGVybS5tZWFzdXJpbmcuU2hhcGUuS2luZBIrCgdhbmNob3JzGAQgAygLMhouaXNvdGhlcm0ubWVhc3VyaW5nLkFuY2hvchI4CgpwYXJhbWV0ZXJzGAUgASgLMiQuaXNvdGhlcm0ubWVhc3VyaW5nLk9iamVjdFBhcmFtZXRlcnMSDQoFZmlyc3QYBiABKAkSDgoGc2Vjb25kGAcgASgJEiAKE2FsYXJtX2Fib3ZlX2NlbHNpdXMYCCABKAFIAIgBARIgChNhbGFybV9iZWxvd19jZWxzaXVzGAkgASgBSAGIAQESEQoJcmVmZXJlbmNlGAogASgJEgwKBHRleHQYCyABKAkiTAoES2luZBIICgRTUE9UEAASCAoETElORRABEggKBEFSRUEQAhIOCgpESUZGRVJFTkNFEAMSDAoIRElTVEFOQ0UQBBIICgROT1RFEAVCFgoUX2FsYXJtX2Fib3ZlX2NlbHNpdXNCFgoUX2FsYXJtX2JlbG93X2NlbHNpdXMiNgoJU2hhcGVMaXN0EikKBnNoYXBlcxgBIAMoCzIZLmlzb3RoZXJtLm1lYXN1cmluZy5TaGFwZSKcBgoLVm94ZWxSZWNvcmQSCwoDaGl0GAEgASgIEioKBXBvaW50GAIgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSKwoGbm9ybWFsGAMgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSHQoQYXBwYXJlbnRfY2Vsc2l1cxgEIAEoAUgAiAEBEhsKDm9iamVjdF9jZWxzaXVzGAUgASgBSAGIAQESFAoHc2lnbWFfaxgGIAEoAUgCiAEBEhsKDm9iamVjdF9zaWdtYV9rGAcgASgBSAOIAQESFwoKZGlzdGFuY2VfbRgIIAEoAUgEiAEBEhYKCWFuZ2xlX2RlZxgJIAEoAUgFiAEBEhYKCW51Y19hZ2VfcxgKIAEoAUgGiAEBEhYKCW51Y19lcG9jaBgLIAEoDUgHiAEBEhQKDG9ic2VydmF0aW9ucxgMIAEoDRIUCgxkZXB0aF93ZWlnaHQYDSABKAESNQoOZGlzdGFuY2VfY2xhc3MYDiABKA4yHS5pc290aGVybS5tZWFzdXJpbmcuQ29uZGl0aW9uEjIKC2FuZ2xlX2NsYXNzGA8gASgOMh0uaXNvdGhlcm0ubWVhc3VyaW5nLkNvbmRpdGlvbhIzCgxtb3Rpb25fY2xhc3MYECABKA4yHS5pc290aGVybS5tZWFzdXJpbmcuQ29uZGl0aW9uEjkKEmRpc2FncmVlbWVudF9jbGFzcxgRIAEoDjIdLmlzb3RoZXJtLm1lYXN1cmluZy5Db25kaXRpb24SGwoOZGlzYWdyZWVtZW50X2sYEiABKAFICIgBARIPCgdxdWFsaXR5GBMgASgJEg8KB3JlYXNvbnMYFCADKAlCEwoRX2FwcGFyZW50X2NlbHNpdXNCEQoPX29iamVjdF9jZWxzaXVzQgoKCF9zaWdtYV9rQhEKD19vYmplY3Rfc2lnbWFfa0INCgtfZGlzdGFuY2VfbUIMCgpfYW5nbGVfZGVnQgwKCl9udWNfYWdlX3NCDAoKX251Y19lcG9jaEIRCg9fZGlzYWdyZWVtZW50X2si3wEKClN0YXRpc3RpY3MSEwoLbWluX2NlbHNpdXMYASABKAESEwoLbWF4X2NlbHNpdXMYAiABKAESFAoMbWVhbl9jZWxzaXVzGAMgASgBEhMKC2RldmlhdGlvbl9rGAQgASgBEhQKB3NpZ21hX2sYBSABKAFIAIgBARIsCgdob3R0ZXN0GAYgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSLAoHY29sZGVzdBgHIAEoCzIbLmlzb3RoZXJtLm1lYXN1cmluZy5WZWN0b3IzQgoKCF9zaWdtYV9rIkkKCUZyYWN0aW9ucxIMCgRnb29kGAEgASgBEhIKCmFjY2VwdGFibGUYAiABKAESCwoDYmFkGAMgASgBEg0KBW5ldmVyGAQgASgBItcBCghIZWF0RmxvdxITCgtyYWRpYXRpb25fdxgBIAEoARIUCgxjb252ZWN0aW9uX3cYAiABKAESDwoHdG90YWxfdxgDIAEoARITCgttZWFzdXJlZF9tMhgEIAEoARIWCg5leHRyYXBvbGF0ZWRfdxgFIAEoARIeChZmaWxtX2NvZWZmaWNpZW50X3dfbTJrGAYgASgBEhMKC2Fpcl9jZWxzaXVzGAcgASgBEhkKEXJlZmxlY3RlZF9jZWxzaXVzGAggASgBEhIKCmVtaXNzaXZpdHkYCSABKAEi8AEKDFByb2ZpbGVQb2ludBIPCgdhbG9uZ19tGAEgASgBEioKBXBvaW50GAIgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSHQoQYXBwYXJlbnRfY2Vsc2l1cxgDIAEoAUgAiAEBEhsKDm9iamVjdF9jZWxzaXVzGAQgASgBSAGIAQESGwoOb2JqZWN0X3NpZ21hX2sYBSABKAFIAogBARIPCgdxdWFsaXR5GAYgASgJQhMKEV9hcHBhcmVudF9jZWxzaXVzQhEKD19vYmplY3RfY2Vsc2l1c0IRCg9fb2JqZWN0X3NpZ21hX2sisQQKDU1lYXN1cmVkU2hhcGUSCgoCaWQYASABKAkSDwoHcHJvYmxlbRgCIAEoCRIvCgZyZWNvcmQYAyABKAsyHy5pc290aGVybS5tZWFzdXJpbmcuVm94ZWxSZWNvcmQSLgoGb2JqZWN0GAQgASgLMh4uaXNvdGhlcm0ubWVhc3VyaW5nLlN0YXRpc3RpY3MSMAoIYXBwYXJlbnQYBSABKAsyHi5pc290aGVybS5tZWFzdXJpbmcuU3RhdGlzdGljcxIuCgdxdWFsaXR5GAYgASgLMh0uaXNvdGhlcm0ubWVhc3VyaW5nLkZyYWN0aW9ucxIPCgdhcmVhX20yGAcgASgBEhAKCGxlbmd0aF9tGAggASgBEhgKEHN1cmZhY2VfbGVuZ3RoX20YCSABKAESMQoHcHJvZmlsZRgKIAMoCzIgLmlzb3RoZXJtLm1lYXN1cmluZy5Qcm9maWxlUG9pbnQSLwoJaGVhdF9mbG93GAsgASgLMhwuaXNvdGhlcm0ubWVhc3VyaW5nLkhlYXRGbG93EhkKDGRpZmZlcmVuY2VfaxgMIAEoAUgAiAEBEh8KEmRpZmZlcmVuY2Vfc2lnbWFfaxgNIAEoAUgBiAEBEg0KBWFsYXJtGA4gASgJEiwKB2Nvcm5lcnMYDyADKAsyGy5pc290aGVybS5tZWFzdXJpbmcuVmVjdG9yM0IPCg1fZGlmZmVyZW5jZV9rQhUKE19kaWZmZXJlbmNlX3NpZ21hX2sigAEKDE1lYXN1cmVtZW50cxIpCgZzaGFwZXMYASADKAsyGS5pc290aGVybS5tZWFzdXJpbmcuU2hhcGUSMwoIbWVhc3VyZWQYAiADKAsyIS5pc290aGVybS5tZWFzdXJpbmcuTWVhc3VyZWRTaGFwZRIQCgh1bmRvYWJsZRgDIAEoDSo9CglDb25kaXRpb24SDQoJVU5DSEVDS0VEEAASBwoDQkFEEAESDgoKQUNDRVBUQUJMRRACEggKBEdPT0QQA2IGcHJvdG8z");var xg=Ui(fa,1),no=Ui(fa,2),pa=Ui(fa,3);var Ul=Ll("CgpsaXZlLnByb3RvEg1pc290aGVybS5saXZlIlcKBFBvc2USCQoBeBgBIAEoARIJCgF5GAIgASgBEgkKAXoYAyABKAESCgoCcXgYBCABKAESCgoCcXkYBSABKAESCgoCcXoYBiABKAESCgoCcXcYByABKAEiywQKDVNlcnZlck1lc3NhZ2USKQoHd2VsY29tZRgBIAEoCzIWLmlzb3RoZXJtLmxpdmUuV2VsY29tZUgAEiMKBHNjYW4YAiABKAsyEy5pc290aGVybS5saXZlLlNjYW5IABIjCgRtYXBzGAMgASgLMhMuaXNvdGhlcm0ubGl2ZS5NYXBzSAASLAoFZ3JvdXAYBCABKAsyGy5pc290aGVybS5saXZlLlN1cmZhY2VHcm91cEgAEi4KB2RldGFpbHMYBSABKAsyGy5pc290aGVybS5saXZlLkdyb3VwRGV0YWlsc0gAEiYKBHBvc2UYBiABKAsyFi5pc290aGVybS5saXZlLlJpZ1Bvc2VIABIjCgRwYXRoGAcgASgLMhMuaXNvdGhlcm0ubGl2ZS5QYXRoSAASKwoIZ3VpZGFuY2UYCCABKAsyFy5pc290aGVybS5saXZlLkd1aWRhbmNlSAASKwoFaW1hZ2UYCSABKAsyGi5pc290aGVybS5saXZlLkNhbWVyYUltYWdlSAASJQoFc3RhdGUYCiABKAsyFC5pc290aGVybS5saXZlLlN0YXRlSAASJwoGYW5zd2VyGAsgASgLMhUuaXNvdGhlcm0ubGl2ZS5BbnN3ZXJIABI4CgxtZWFzdXJlbWVudHMYDCABKAsyIC5pc290aGVybS5tZWFzdXJpbmcuTWVhc3VyZW1lbnRzSAASKwoIcGxheWJhY2sYDSABKAsyFy5pc290aGVybS5saXZlLlBsYXliYWNrSABCCQoHY29udGVudCLoAQoHV2VsY29tZRIYChBzb2Z0d2FyZV92ZXJzaW9uGAEgASgJEhAKCHByb3RvY29sGAIgASgNEiEKBHJvbGUYAyABKA4yEy5pc290aGVybS5saXZlLlJvbGUSLQoIcGFsZXR0ZXMYBCADKAsyGy5pc290aGVybS5saXZlLlBhbGV0dGVUYWJsZRIuCghyYWRpYW5jZRgFIAEoCzIcLmlzb3RoZXJtLmxpdmUuUmFkaWFuY2VUYWJsZRIvCgltYXRlcmlhbHMYBiADKAsyHC5pc290aGVybS5saXZlLk1hdGVyaWFsVGFibGUiLQoMUGFsZXR0ZVRhYmxlEgwKBG5hbWUYASABKAkSDwoHY29sb3VycxgCIAEoDCJLCg1SYWRpYW5jZVRhYmxlEhMKC21pbl9jZWxzaXVzGAEgASgBEhMKC21heF9jZWxzaXVzGAIgASgBEhAKCHJhZGlhbmNlGAMgAygCIkMKDU1hdGVyaWFsVGFibGUSDAoEbmFtZRgBIAEoCRISCgplbWlzc2l2aXR5GAIgASgBEhAKCGJ5X2FuZ2xlGAMgAygCIlcKBkNhbWVyYRINCgV3aWR0aBgBIAEoDRIOCgZoZWlnaHQYAiABKA0SCgoCZngYAyABKAESCgoCZnkYBCABKAESCgoCY3gYBSABKAESCgoCY3kYBiABKAEiwQMKBFNjYW4SDQoFbW9kZWwYASABKAQSKAoFcGhhc2UYAiABKA4yGS5pc290aGVybS5saXZlLlNjYW4uUGhhc2USDAoEbmFtZRgDIAEoCRIOCgZmb2xkZXIYBCABKAkSCwoDcmlnGAUgASgJEi8KCnZvbHVtZV9taW4YBiABKAsyGy5pc290aGVybS5tZWFzdXJpbmcuVmVjdG9yMxIvCgp2b2x1bWVfbWF4GAcgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSFAoMdm94ZWxfc2l6ZV9tGAggASgBEiQKBWRlcHRoGAkgASgLMhUuaXNvdGhlcm0ubGl2ZS5DYW1lcmESJgoHdGhlcm1hbBgKIAEoCzIVLmlzb3RoZXJtLmxpdmUuQ2FtZXJhEiwKD1RfdGhlcm1hbF9kZXB0aBgLIAEoCzITLmlzb3RoZXJtLmxpdmUuUG9zZRIlCgZsaW1pdHMYDCABKAsyFS5pc290aGVybS5saXZlLkxpbWl0cyI6CgVQaGFzZRILCgdXQUlUSU5HEAASCwoHUlVOTklORxABEgkKBUVOREVEEAISDAoIRklOSVNIRUQQAyKpAQoGTGltaXRzEhYKDmRpc3RhbmNlX21pbl9tGAEgASgBEhcKD2Rpc3RhbmNlX2dvb2RfbRgCIAEoARIWCg5kaXN0YW5jZV9tYXhfbRgDIAEoARIVCg1hbmdsZV9taW5fZGVnGAQgASgBEhYKDmFuZ2xlX2dvb2RfZGVnGAUgASgBEhUKDWFuZ2xlX21heF9kZWcYBiABKAESEAoIbWF0ZXJpYWwYByABKAkifgoETWFwcxIlCgRtYXBzGAEgAygLMhcuaXNvdGhlcm0ubGl2ZS5NYXBzLk1hcBIOCgZhY3RpdmUYAiABKA0aPwoDTWFwEigKC1Rfd29ybGRfbWFwGAEgASgLMhMuaXNvdGhlcm0ubGl2ZS5Qb3NlEg4KBmpvaW5lZBgCIAEoCCI4CghHcm91cEtleRILCgNtYXAYASABKA0SCQoBeBgCIAEoERIJCgF5GAMgASgREgkKAXoYBCABKBEigQIKDFN1cmZhY2VHcm91cBIkCgNrZXkYASABKAsyFy5pc290aGVybS5saXZlLkdyb3VwS2V5Eg8KB3ZlcnNpb24YAiABKA0SKwoGb3JpZ2luGAMgASgLMhsuaXNvdGhlcm0ubWVhc3VyaW5nLlZlY3RvcjMSDQoFc2NhbGUYBCABKAESFAoMdmVydGV4X2NvdW50GAUgASgNEhMKC2luZGV4X2NvdW50GAYgASgNEhAKCHZlcnRpY2VzGAcgASgMEg8KB2luZGljZXMYCCABKAwSFwoPY2FwdHVyZV90aW1lX25zGAkgASgEEhcKD2NoYW5nZWRfdGltZV9ucxgKIAEoBCJsCgxHcm91cERldGFpbHMSJAoDa2V5GAEgASgLMhcuaXNvdGhlcm0ubGl2ZS5Hcm91cEtleRIPCgd2ZXJzaW9uGAIgASgNEhQKDHZlcnRleF9jb3VudBgDIAEoDRIPCgdkZXRhaWxzGAQgASgMIpoBCgdSaWdQb3NlEgsKA21hcBgBIAEoDRIoCgtUX21hcF9kZXB0aBgCIAEoCzITLmlzb3RoZXJtLmxpdmUuUG9zZRIpCgh0cmFja2luZxgDIAEoDjIXLmlzb3RoZXJtLmxpdmUuVHJhY2tpbmcSFwoPY2FwdHVyZV90aW1lX25zGAQgASgEEhQKDGZyYW1lX251bWJlchgFIAEoBCJXCgRQYXRoEicKBXBhcnRzGAEgAygLMhguaXNvdGhlcm0ubGl2ZS5QYXRoLlBhcnQaJgoEUGFydBILCgNtYXAYASABKA0SEQoJcG9zaXRpb25zGAIgAygCIlIKCUZyYWN0aW9ucxIMCgRnb29kGAEgASgBEhIKCmFjY2VwdGFibGUYAiABKAESCwoDYmFkGAMgASgBEhYKDm5ldmVyX21lYXN1cmVkGAQgASgBIssCCghHdWlkYW5jZRIpCgh0cmFja2luZxgBIAEoDjIXLmlzb3RoZXJtLmxpdmUuVHJhY2tpbmcSDgoGYWR2aWNlGAIgASgJEg4KBnJlYXNvbhgDIAEoCRINCgVraW5kcxgEIAMoCRInCgVtb2RlbBgFIAEoCzIYLmlzb3RoZXJtLmxpdmUuRnJhY3Rpb25zEiYKBHZpZXcYBiABKAsyGC5pc290aGVybS5saXZlLkZyYWN0aW9ucxISCgpzdXJmYWNlX20yGAcgASgBEgwKBGRvbmUYCCABKAgSFQoNZG9uZV9mcmFjdGlvbhgJIAEoARIvChJUX3dvcmxkX2RlcHRoX25leHQYCiABKAsyEy5pc290aGVybS5saXZlLlBvc2USFAoMbmV4dF9nYWluX20yGAsgASgBEhQKDGZyYW1lX251bWJlchgMIAEoBCLHAQoLQ2FtZXJhSW1hZ2USMQoGc2Vuc29yGAEgASgOMiEuaXNvdGhlcm0ubGl2ZS5DYW1lcmFJbWFnZS5TZW5zb3ISCwoDcG5nGAIgASgMEgsKA21pbhgDIAEoARILCgNtYXgYBCABKAESFAoMZnJhbWVfbnVtYmVyGAUgASgEEhcKD2NhcHR1cmVfdGltZV9ucxgGIAEoBBINCgV2YWxpZBgHIAEoCCIgCgZTZW5zb3ISCQoFREVQVEgQABILCgdUSEVSTUFMEAEi0QEKBlN0cmVhbRIPCgdwcmVzZW50GAEgASgIEg8KB3JhdGVfaHoYAiABKAESEAoIY2FwdHVyZWQYAyABKAQSEAoIcmVjZWl2ZWQYBCABKAQSDwoHbWlzc2luZxgFIAEoBBINCgVxdWV1ZRgGIAEoDRIrCgdkcm9wcGVkGAcgAygLMhouaXNvdGhlcm0ubGl2ZS5TdHJlYW0uRHJvcBIMCgRtb2RlGAggASgJGiYKBERyb3ASDgoGcmVhc29uGAEgASgJEg4KBmZyYW1lcxgCIAEoBCLhAQoDTnVjEg0KBXN0YXRlGAEgASgJEg4KBnBvbGljeRgCIAEoCRIaCg1zZWNvbmRzX3NpbmNlGAMgASgBSACIAQESDgoGcmVhc29uGAQgASgJEhIKCndhcm1pbmdfdXAYBSABKAgSDQoFc3Rvcm0YBiABKAgSGAoLZnBhX2NlbHNpdXMYByABKAFIAYgBARIcCg9ob3VzaW5nX2NlbHNpdXMYCCABKAFIAogBAUIQCg5fc2Vjb25kc19zaW5jZUIOCgxfZnBhX2NlbHNpdXNCEgoQX2hvdXNpbmdfY2Vsc2l1cyLJBwoFU3RhdGUSJwoEbGluaxgBIAEoCzIZLmlzb3RoZXJtLmxpdmUuU3RhdGUuTGluaxIkCgVkZXB0aBgCIAEoCzIVLmlzb3RoZXJtLmxpdmUuU3RyZWFtEiYKB3RoZXJtYWwYAyABKAsyFS5pc290aGVybS5saXZlLlN0cmVhbRIfCgNudWMYBCABKAsyEi5pc290aGVybS5saXZlLk51YxInCgRkaXNrGAUgASgLMhkuaXNvdGhlcm0ubGl2ZS5TdGF0ZS5EaXNrEicKBGxvYWQYBiABKAsyGS5pc290aGVybS5saXZlLlN0YXRlLkxvYWQSLQoHY29uc29sZRgHIAEoCzIcLmlzb3RoZXJtLmxpdmUuU3RhdGUuQ29uc29sZRISCgpzY2FuX3N0YXRlGAggASgJEhkKEW1vdmVkX2NhbGlicmF0aW9uGAkgASgJGrcBCgRMaW5rEhMKC3JpZ19wcmVzZW50GAEgASgIEg8KB3Byb2JsZW0YAiABKAkSFgoOcHVibGlzaF9wb2xpY3kYAyABKAkSFgoOYmFja2xvZ19mcmFtZXMYBCABKAQSDQoFY2xvY2sYBSABKAkSGgoSY2xvY2tfc3luY2hyb25pc2VkGAYgASgIEhsKDmZlZWRiYWNrX3A1MF9zGAcgASgBSACIAQFCEQoPX2ZlZWRiYWNrX3A1MF9zGroBCgREaXNrEhsKDnJpZ19mcmVlX2J5dGVzGAEgASgESACIAQESFwoKZnJlZV9ieXRlcxgCIAEoBEgBiAEBEgwKBHRleHQYAyABKAkSEQoJcmVjb3JkaW5nGAQgASgJEhcKD3JlY29yZGluZ19ieXRlcxgFIAEoBBIQCghsZWZ0X291dBgGIAEoBBIOCgZwYXVzZWQYByABKAhCEQoPX3JpZ19mcmVlX2J5dGVzQg0KC19mcmVlX2J5dGVzGn4KBExvYWQSDgoGYmVoaW5kGAEgASgIEhgKEHRoZXJtYWxfbGVmdF9vdXQYAiABKAQSHAoUZGVwdGhfbm90X2ludGVncmF0ZWQYAyABKAQSHQoVcmVzdWx0c19iZWluZ193cml0dGVuGAQgASgNEg8KB3Byb2JsZW0YBSABKAkagAEKB0NvbnNvbGUSDwoHdmlld2VycxgBIAEoDRISCgpzZW50X2J5dGVzGAIgASgEEhYKDmdyb3Vwc193YWl0aW5nGAMgASgNEg4KBmdyb3VwcxgEIAEoDRIPCgdyZWZ1c2VkGAUgASgEEhcKD2Ryb3BwZWRfY2xpZW50cxgGIAEoBCJjCghQbGF5YmFjaxISCgpkdXJhdGlvbl9zGAEgASgBEhIKCnBvc2l0aW9uX3MYAiABKAESDQoFc3BlZWQYAyABKAESDwoHcGxheWluZxgEIAEoCBIPCgdzZWVraW5nGAUgASgIInEKBkFuc3dlchIOCgZudW1iZXIYASABKAQSDAoEZG9uZRgCIAEoCBIMCgR0ZXh0GAMgASgJEjEKBnJlY29yZBgEIAEoCzIfLmlzb3RoZXJtLm1lYXN1cmluZy5Wb3hlbFJlY29yZEgAQggKBnJlc3VsdCKbAgoNQ2xpZW50TWVzc2FnZRIOCgZudW1iZXIYASABKAQSJQoFaGVsbG8YAiABKAsyFC5pc290aGVybS5saXZlLkhlbGxvSAASIwoEdmlldxgDIAEoCzITLmlzb3RoZXJtLmxpdmUuVmlld0gAEiUKBW9yZGVyGAQgASgLMhQuaXNvdGhlcm0ubGl2ZS5PcmRlckgAEiMKBHBpY2sYBSABKAsyEy5pc290aGVybS5saXZlLlBpY2tIABIjCgRlZGl0GAYgASgLMhMuaXNvdGhlcm0ubGl2ZS5FZGl0SAASMgoIcGxheWJhY2sYByABKAsyHi5pc290aGVybS5saXZlLlBsYXliYWNrQ29udHJvbEgAQgkKB2NvbnRlbnQikgEKBUhlbGxvEhAKCHByb3RvY29sGAEgASgNEg0KBW1vZGVsGAIgASgEEikKBmdyb3VwcxgDIAMoCzIZLmlzb3RoZXJtLmxpdmUuSGVsbG8uSGF2ZRo9CgRIYXZlEiQKA2tleRgBIAEoCzIXLmlzb3RoZXJtLmxpdmUuR3JvdXBLZXkSDwoHdmVyc2lvbhgCIAEoDSJqCgRWaWV3EigKA2V5ZRgBIAEoCzIbLmlzb3RoZXJtLm1lYXN1cmluZy5WZWN0b3IzEg8KB2RldGFpbHMYAiABKAgSDgoGaW1hZ2VzGAMgASgIEhcKD21heF9ieXRlc19wZXJfcxgEIAEoDSK/AQoFT3JkZXISJwoEa2luZBgBIAEoDjIZLmlzb3RoZXJtLmxpdmUuT3JkZXIuS2luZBIOCgZob2xkX3MYAiABKAEifQoES2luZBIICgROT05FEAASDgoKU1RBUlRfU0NBThABEg0KCVNUT1BfU0NBThACEgsKB05VQ19OT1cQAxIMCghIT0xEX05VQxAEEhEKDU5VQ19BVVRPTUFUSUMQBRIOCgpOVUNfTUFOVUFMEAYSDgoKTlVDX0NBTUVSQRAHImkKBFBpY2sSJwoDcmF5GAEgASgLMhouaXNvdGhlcm0ubWVhc3VyaW5nLkFuY2hvchI4CgpwYXJhbWV0ZXJzGAIgASgLMiQuaXNvdGhlcm0ubWVhc3VyaW5nLk9iamVjdFBhcmFtZXRlcnMieQoPUGxheWJhY2tDb250cm9sEhcKCnBvc2l0aW9uX3MYASABKAFIAIgBARISCgVzcGVlZBgCIAEoAUgBiAEBEhQKB3BsYXlpbmcYAyABKAhIAogBAUINCgtfcG9zaXRpb25fc0IICgZfc3BlZWRCCgoIX3BsYXlpbmcibQoERWRpdBIoCgNwdXQYASABKAsyGS5pc290aGVybS5tZWFzdXJpbmcuU2hhcGVIABIQCgZyZW1vdmUYAiABKAlIABIPCgVjbGVhchgDIAEoCEgAEg4KBHVuZG8YBCABKAhIAEIICgZjaGFuZ2UqIAoEUm9sZRIKCgZWSUVXRVIQABIMCghPUEVSQVRPUhABKkUKCFRyYWNraW5nEhQKEFRSQUNLSU5HX1dBSVRJTkcQABILCgdUUkFDS0VEEAESDAoIREVHUkFERUQQAhIICgRMT1NUEANiBnByb3RvMw",[fa]);var vg=Ui(Ul,1);var pd=Ui(Ul,23);var bg=Ui(Ul,26);var Sg=Ui(Ul,28);var Mg=1,Ol=class{socket=null;handlers=new Map;waiting=new Map;nextNumber=1n;retry_ms=250;received_bytes=0;stopped=!1;held=()=>({model:0n,groups:[]});onState=()=>{};on(e,t){let i=this.handlers.get(e)??[];i.push(t),this.handlers.set(e,i)}open(){let e=new URL("live",location.href);e.protocol=e.protocol==="https:"?"wss:":"ws:";let t=new WebSocket(e,"isotherm.live.v1");t.binaryType="arraybuffer",this.socket=t,t.addEventListener("open",()=>{this.retry_ms=250;let i=this.held();this.post({case:"hello",value:{protocol:Mg,model:i.model,groups:i.groups}}),this.onState(!0)}),t.addEventListener("message",i=>this.take(i.data)),t.addEventListener("close",()=>this.closed())}post(e){return this.sendWith(0n,e)}ask(e){let t=this.nextNumber++;return new Promise(i=>{this.sendWith(t,e)?this.waiting.set(t,i):i(null)})}takeReceivedBytes(){let e=this.received_bytes;return this.received_bytes=0,e}drop(){this.socket?.close()}sendWith(e,t){return this.socket?.readyState!==WebSocket.OPEN?!1:(this.socket.send(dd(pd,sn(pd,{number:e,content:t}))),!0)}take(e){this.received_bytes+=e.byteLength;let{content:t}=da(vg,new Uint8Array(e));if(t.case!==void 0){if(t.case==="welcome"&&t.value.protocol!==Mg){this.stopped=!0,location.reload();return}t.case==="answer"&&(this.waiting.get(t.value.number)?.(t.value),this.waiting.delete(t.value.number));for(let i of this.handlers.get(t.case)??[])i(t.value)}}closed(){for(let e of this.waiting.values())e(null);this.waiting.clear(),this.onState(!1),!this.stopped&&(setTimeout(()=>this.open(),this.retry_ms),this.retry_ms=Math.min(4e3,this.retry_ms*2))}};function X(n,e={},...t){let i=document.createElement(n);for(let[s,r]of Object.entries(e))r==null||r===!1||(s==="class"?i.className=String(r):s.startsWith("on")?i.addEventListener(s.slice(2),r):s.includes("-")||s==="role"||s==="for"?i.setAttribute(s,String(r)):i[s]=r);return Xs(i,...t),i}function Xs(n,...e){for(let t of e)t==null||t===!1||n.append(t)}function Pt(n,e){n.textContent!==e&&(n.textContent=e)}function Vt(n,e){n.hidden=!e}function Eg(n,e,t,i){let s=new Map,r=a=>{for(let[c,l]of s)l.setAttribute("aria-pressed",String(c===a))},o=X("div",{class:"segmented",role:"group","aria-label":n});for(let[a,c]of e){let l=X("button",{type:"button",onclick:()=>{r(a),i(a)}},c);s.set(a,l),o.append(l)}return r(t),{element:o,set:r}}function vr(n,e,t){let i=X("input",{type:"checkbox",checked:e,role:"switch"});return i.addEventListener("change",()=>t(i.checked)),{element:X("label",{class:"toggle"},i,X("span",{class:"knob","aria-hidden":"true"}),X("span",{},n)),input:i}}function io(n,e,t,i){let s=X("select",{"aria-label":n},...e.map(([r,o])=>X("option",{value:r,selected:r===t},o)));return s.addEventListener("change",()=>i(s.value)),{element:X("label",{class:"field"},X("span",{},n),s),input:s}}function Ys(n,e,t,i,s,r={}){let o=X("input",{type:"number",inputMode:"decimal",step:String(i),value:String(t),min:r.min===void 0?"":String(r.min),max:r.max===void 0?"":String(r.max)});return o.addEventListener("change",()=>{let a=Number(o.value);o.value!==""&&Number.isFinite(a)&&o.checkValidity()&&s(a)}),{element:X("label",{class:"field"},X("span",{},n),X("span",{class:"with-unit"},o,X("span",{class:"unit"},e))),input:o}}function Bl(n,e){let t=`isotherm.${n}`;return{get:()=>{try{let i=localStorage.getItem(t);return i===null?e:JSON.parse(i)}catch{return e}},set:i=>{try{localStorage.setItem(t,JSON.stringify(i))}catch{}}}}var md=[["celsius","°C"],["fahrenheit","°F"],["kelvin","K"]];function Jn(n){return md.find(([e])=>e===n)[1]}function jn(n,e){return e==="fahrenheit"?n*1.8+32:e==="kelvin"?n+273.15:n}function ys(n,e){return e==="fahrenheit"?(n-32)/1.8:e==="kelvin"?n-273.15:n}function kl(n,e){return e==="fahrenheit"?n*1.8:n}function Mi(n,e,t=1){return n===void 0||!Number.isFinite(n)?"–":`${jn(n,e).toFixed(t)} ${Jn(e)}`}function xs(n,e,t=1){return n===void 0||!Number.isFinite(n)?"–":`${kl(n,e).toFixed(t)} ${e==="fahrenheit"?"°F":"K"}`}function vs(n){if(n===void 0)return"–";let e=Number(n);return e>=1e12?`${(e/1e12).toFixed(1)} TB`:e>=1e9?`${(e/1e9).toFixed(1)} GB`:e>=1e6?`${(e/1e6).toFixed(0)} MB`:`${(e/1e3).toFixed(0)} kB`}function Oi(n){return n===void 0||!Number.isFinite(n)?"–":`${(100*n).toFixed(0)} %`}var sb={"mesh.ply":"mesh, coloured and with temperatures","cloud.ply":"points with all that is known of each","model.iso":"model, for isotherm view, measure, render and export","stats.json":"figures of the scan","trajectory.txt":"path of the rig"},Gl=class{constructor(e){this.connection=e;let t=(i,s,r="",o=0)=>{let a=X("button",{type:"button",class:`order ${r}`,onclick:()=>{this.give(i,s,o)}},i);return this.buttons.push(a),a};this.policy=X("span",{class:"now"}),Xs(this.element,this.viewer,X("h3",{},"Scan"),X("div",{class:"grid"},t("Start scan",1,"go"),t("Stop and save",2,"stop")),X("h3",{},"Results"),this.results,X("h3",{},"Correction (NUC) ",this.policy),X("div",{class:"grid"},t("Correct now",3),t("Hold 30 s",4,"",30),t("Hold 2 min",4,"",120),t("End hold",4,"",0)),X("div",{class:"grid three"},t("Automatic",5),t("Manual",6),t("Camera",7)),X("h3",{},"Answers"),this.log)}connection;element=X("div",{class:"control"});log=X("ol",{class:"answers","aria-live":"polite","aria-label":"Answers of the rig"});buttons=[];policy;results=X("div",{class:"results"});viewer=X("p",{class:"note",hidden:!0},"You may look and measure. Orders need the operator's link.");setRole(e){this.viewer.hidden=e===1;for(let t of this.buttons)t.disabled=e!==1}setScan(e){let t=i=>this.results.replaceChildren(X("p",{class:"note"},i));if(e.phase!==2&&e.phase!==3)return t("Written when the scan ends, then to be had here.");fetch("api/files").then(async i=>await i.json()).then(({files:i})=>{if(i.length===0)return t("There are none in this folder.");let s=({name:o,bytes:a})=>X("li",{},X("a",{href:`api/files/${o}`,download:o.split("/").at(-1)},o),X("small",{},[sb[o]??"rendering",vs(a)].join(", "))),r=o=>Number(o.includes("/"));this.results.replaceChildren(X("ul",{class:"files"},...i.sort((o,a)=>r(o.name)-r(a.name)).map(s)))}).catch(()=>t("The list of files could not be fetched."))}setState(e){Pt(this.policy,e.nuc?.policy?e.nuc.policy:"")}tell(e,t,i){let s=new Date().toLocaleTimeString();for(this.log.prepend(X("li",{"data-tone":i},X("strong",{},e),X("span",{},t),X("time",{},s)));this.log.children.length>12;)this.log.lastChild.remove()}async give(e,t,i){let s=await this.connection.ask({case:"order",value:sn(bg,{kind:t,holdS:i})});s?this.tell(e,s.text!==""?s.text:s.done?"done":"refused",s.done?"good":"bad"):this.tell(e,"the connection is gone: not sent, or the answer was lost","bad")}};var Ag={closer:"⇥",farther:"⇤",less_oblique:"∡",more_oblique:"∠",slower:"◴",hold_for_nuc:"❚❚",go_back:"↶",done:"✓"},Tg={closer:[660,880],farther:[880,660],less_oblique:[660,660],more_oblique:[550,550],slower:[440,330,440],hold_for_nuc:[520,0,520],go_back:[330,262,220],done:[523,659,784,1047]},Vl=class{constructor(e,t){this.name=e;this.parts=["good","acceptable","bad","never"].map(i=>X("span",{class:i})),this.meter=X("div",{class:"bar",role:"img","aria-label":`${e}: nothing seen yet`},...this.parts),this.element=X("div",{class:"coverage",title:t},X("span",{class:"name"},e),this.meter,this.text)}name;element;parts;text=X("strong",{},"–");meter;set(e){let t=e?[e.good,e.acceptable,e.bad,e.neverMeasured]:[0,0,0,0];this.parts.forEach((i,s)=>{i.style.width=`${(100*t[s]).toFixed(1)}%`}),Pt(this.text,e?Oi(e.good):"–"),this.meter.setAttribute("aria-label",e?`${this.name}: ${Oi(e.good)} measured well, ${Oi(e.acceptable)} acceptably, ${Oi(e.bad)} badly, ${Oi(e.neverMeasured)} never`:`${this.name}: nothing seen yet`)}},zl=class{element;sound;icon=X("span",{class:"icon","aria-hidden":"true"});sentence=X("p",{class:"sentence"},"Waiting for a scan");reason=X("p",{class:"reason"});view=new Vl("View","The surface in view, by how well it was measured");model=new Vl("Model","The whole surface so far, by how well it was measured");area=X("span",{class:"area"});bars=X("div",{class:"bars"});memory=Bl("sound",!1);audio=null;kind="";guidance;constructor(){this.sound=X("button",{type:"button",class:"chip","aria-pressed":String(this.memory.get()),title:"Sounds for advice (S)",onclick:()=>this.toggleSound()},"Sound"),this.element=X("section",{class:"guidance","aria-label":"Guidance"},X("div",{class:"advice",role:"status","aria-live":"polite"},this.icon,X("div",{},this.sentence,this.reason)),this.bars),this.bars.append(this.view.element,this.model.element,this.area),Vt(this.bars,!1)}toggleSound(){let e=!this.memory.get();this.memory.set(e),this.sound.setAttribute("aria-pressed",String(e)),e&&this.play([660])}end(e,t){this.guidance=void 0,this.say("",e,t,"idle")}clear(e,t=""){this.end(e,t),this.view.set(void 0),this.model.set(void 0),Pt(this.area,""),Vt(this.bars,!1)}set(e,t){Vt(this.bars,!0),this.guidance=e,this.view.set(e.view),this.model.set(e.model),Pt(this.area,e.surfaceM2>0?`${e.surfaceM2.toFixed(2)} m²`:""),this.update(t)}update(e){let{guidance:t}=this;if(!t)return;let i=t.kinds[0]??"",s=t.tracking===3,r=t.TWorldDepthNext&&t.nextGainM2>0?`the next view would add ${(t.nextGainM2*1e4).toFixed(0)} cm²`:"",o=t.advice!==""?rb(t.advice):s?"Tracking is lost":"Go on scanning",a=t.reason!==""?t.reason:r,c=t.done||i==="done"?"done":s||i==="go_back"?"alarm":t.advice!==""?"advise":"fine";this.say(i,o,e?.load?.behind===!0?`${a}${a===""?"":" · "}the ground is behind`:a,c),i!==this.kind&&(this.kind=i,this.memory.get()&&Tg[i]&&this.play(Tg[i]))}say(e,t,i,s){Pt(this.icon,Ag[e]??""),Vt(this.icon,Ag[e]!==void 0),Pt(this.sentence,t),Pt(this.reason,i),this.element.dataset.tone=s}play(e){this.audio??=new AudioContext,this.audio.resume();let t=this.audio.currentTime+.02;for(let i of e){if(i>0){let s=this.audio.createOscillator(),r=this.audio.createGain();s.frequency.value=i,r.gain.setValueAtTime(1e-4,t),r.gain.exponentialRampToValueAtTime(.25,t+.02),r.gain.exponentialRampToValueAtTime(1e-4,t+.16),s.connect(r).connect(this.audio.destination),s.start(t),s.stop(t+.17)}t+=.18}}};function rb(n){return n===""?"":n[0].toUpperCase()+n.slice(1)}var Hl=class{constructor(e,t){this.text=t;this.canvas=X("canvas",{width:320,height:240,role:"img","aria-label":`${e} image: none yet`}),this.element=X("figure",{class:"camera"},X("figcaption",{},X("strong",{},e),this.caption),this.canvas,this.badge)}text;element;canvas;caption=X("span",{class:"range"});badge=X("span",{class:"badge bad",hidden:!0},"Shutter or settling: no temperatures");colours;image;grey;setColours(e){this.colours=e,this.draw()}async set(e){if(e.png.length===0)return;let t=await createImageBitmap(new Blob([e.png],{type:"image/png"}),{colorSpaceConversion:"none"}),s=new OffscreenCanvas(t.width,t.height).getContext("2d");s.drawImage(t,0,0),this.grey=s.getImageData(0,0,t.width,t.height).data,(this.canvas.width!==t.width||this.canvas.height!==t.height)&&(this.canvas.width=t.width,this.canvas.height=t.height),t.close(),this.image=e,this.draw()}redraw(){this.draw()}draw(){if(!this.image||!this.grey)return;let e=this.canvas.getContext("2d"),t=e.createImageData(this.canvas.width,this.canvas.height);for(let s=0;s<this.grey.length;s+=4){let r=this.grey[s];if(r>0){let o=3*Math.round((r-1)*255/254);t.data[s]=this.colours?.[o]??r,t.data[s+1]=this.colours?.[o+1]??r,t.data[s+2]=this.colours?.[o+2]??r}t.data[s+3]=255}e.putImageData(t,0,0);let i=this.text(this.image);Pt(this.caption,i),this.canvas.setAttribute("aria-label",i),this.badge.hidden=this.image.valid}};function Bn(n){let e=X("dd",{},"–");return{element:X("div",{},X("dt",{},n),e),set:(t,i="")=>{Pt(e,t),e.dataset.tone=i}}}var Wl=class{element=X("div",{class:"inputs"});depth;thermal;rows={link:Bn("Rig"),depth:Bn("Depth"),thermal:Bn("Thermal"),dropped:Bn("Dropped"),missing:Bn("Missing"),backlog:Bn("Backlog"),nuc:Bn("Correction"),temperatures:Bn("Camera"),clock:Bn("Clock"),age:Bn("Feedback age"),rigDisk:Bn("Rig's disk"),disk:Bn("Disk here"),recording:Bn("Recording"),load:Bn("Ground"),calibration:Bn("Calibration"),page:Bn("This page")};constructor(e){this.depth=new Hl("Depth",i=>`${i.min.toFixed(2)} to ${i.max.toFixed(2)} m`),this.thermal=new Hl("Thermal",i=>{let{unit:s}=e.value;return`${jn(i.min,s).toFixed(1)} to ${jn(i.max,s).toFixed(1)} ${Jn(s)}`}),this.element.append(X("div",{class:"cameras"},this.thermal.element,this.depth.element));let t=X("dl",{class:"facts"});for(let i of Object.values(this.rows))t.append(i.element);Xs(this.element,t),e.onChange(()=>this.thermal.redraw())}setColours(e){this.thermal.setColours(e)}setImage(e){(e.sensor===0?this.depth:this.thermal).set(e)}setPage(e){this.rows.page.set(e)}setState(e,t){let{rows:i}=this,{link:s,nuc:r,disk:o,load:a}=e;i.link.set(s?.problem?s.problem:s?.rigPresent?`connected, ${e.scanState||"idle"}, ${s.publishPolicy}`:"not there",s?.problem||!s?.rigPresent?"bad":"good");let c=u=>u?.present?`${u.rateHz.toFixed(1)} per second, ${u.received} of ${u.captured}`:"none";i.depth.set(c(e.depth)),i.thermal.set(c(e.thermal));let l=[...e.depth?.dropped??[],...e.thermal?.dropped??[]].filter(({frames:u})=>u>0n);i.dropped.set(l.length===0?"none":l.map(({reason:u,frames:d})=>`${d} ${u}`).join(", "),l.length>0?"warn":"");let h=Number(e.depth?.missing??0n)+Number(e.thermal?.missing??0n);i.missing.set(h===0?"none":String(h),h>0?"warn":""),i.backlog.set(s?`${s.backlogFrames} frames`:"–",Number(s?.backlogFrames??0n)>100?"warn":""),i.nuc.set(r?`${r.state}${r.secondsSince===void 0?"":`, ${r.secondsSince.toFixed(0)} s ago`}${r.reason?` (${r.reason})`:""}, ${r.policy}`:"–",r?.storm?"bad":""),i.temperatures.set(r?`detector ${Mi(r.fpaCelsius,t)}, housing ${Mi(r.housingCelsius,t)}${r.warmingUp?", warming up":""}`:"–",r?.warmingUp?"warn":""),i.clock.set(s?.clock?s.clock:"–",s&&!s.clockSynchronised?"warn":""),i.age.set(s?.feedbackP50S===void 0?"–":`${(s.feedbackP50S*1e3).toFixed(0)} ms`),i.rigDisk.set(o?.rigFreeBytes===void 0?"–":`${vs(o.rigFreeBytes)} free`,Number(o?.rigFreeBytes??1e12)<4e9?"warn":""),i.disk.set(o?.freeBytes===void 0?"–":`${vs(o.freeBytes)} free${o.text?`, ${o.text.replace(/^disk: /,"")}`:""}`),i.recording.set(o?.recording?`${vs(o.recordingBytes)}${o.paused?", paused":""}${o.leftOut>0n?`, lacks ${o.leftOut} frames`:""}`:"none",o?.paused||(o?.leftOut??0n)>0n?"bad":""),i.load.set(a?.problem?a.problem:a?.behind?`behind: ${a.thermalLeftOut} thermal frames left out`:"keeps up",a?.problem?"bad":a?.behind?"warn":"good"),i.calibration.set(e.movedCalibration||"–",e.movedCalibration?"bad":"")}};var bs=[["thermal","Temperature","Apparent or object temperature"],["coverage","Coverage","Measured well, acceptably, badly, or not at all"],["distance","Distance","Class of the measurement distance"],["angle","Angle","Class of the emission angle"],["motion","Motion","Class of the smear while it was measured"],["disagreement","Disagreement","How far measurements under good conditions contradict each other"],["age","NUC age","Seconds since the camera's correction"],["uncertainty","Uncertainty","Standard uncertainty of the temperature"],["geometry","Geometry","The surface only"]],ob={layer:"thermal",palette:"iron",unit:"celsius",locked:!0,widens:!0,min_celsius:NaN,max_celsius:NaN,isotherms:[],interpret:!1,emissivity:.95,reflected_celsius:23,material:"",shading:!0,showVolume:!0,showPath:!0,showCameras:!0,showNext:!0,follow:!0},Xl=class{memory=Bl("look",{});listeners=[];value;constructor(){let e=this.memory.get();this.value={...ob,...e},typeof this.value.min_celsius!="number"&&(this.value.min_celsius=NaN),typeof this.value.max_celsius!="number"&&(this.value.max_celsius=NaN)}onChange(e){this.listeners.push(e),e(this.value,new Set(Object.keys(this.value)))}set(e){let t=new Set(Object.keys(e).filter(i=>this.value[i]!==e[i]));if(t.size!==0){this.value={...this.value,...e},this.memory.set(this.value);for(let i of this.listeners)i(this.value,t)}}};var Ei={good:"#3ddc84",acceptable:"#ffd23f",bad:"#ff4d4f",unchecked:"#6b5fa0",never:"#2b313b",missing:"#ff2fb3",onlyBad:"#ff9600"};function ab(n,e){let{good:t,acceptable:i,bad:s,unchecked:r,never:o}=Ei,a=l=>l===void 0?"?":`${(l*100).toFixed(0)} cm`,c=l=>l===void 0?"?":`${l.toFixed(0)}°`;switch(n.layer){case"distance":return[[t,"good",`${a(e?.distanceMinM)} to ${a(e?.distanceGoodM)}`],[i,"acceptable",`up to ${a(e?.distanceMaxM)}`],[s,"bad","nearer or farther"],[o,"not measured",""]];case"angle":return[[t,"good",`${c(e?.angleMinDeg)} to ${c(e?.angleGoodDeg)}`],[i,"acceptable",`up to ${c(e?.angleMaxDeg)}`],[s,"bad","too oblique, or a mirror image"],[o,"not measured",""]];case"motion":return[[t,"sharp",""],[i,"a little smeared",""],[s,"smeared",""],[r,"not checked",""],[o,"not measured",""]];case"disagreement":return[[t,"measurements agree",""],[i,"differ a little",""],[s,"contradict each other","a reflection, or it changed"],[r,"too few to compare",""],[o,"not measured",""]];case"coverage":return[["#bac1c4","measured well",""],["#788c96","acceptable",""],[Ei.onlyBad,"only badly","measure again"],[Ei.missing,"not measured","seen by depth only"]];default:return[]}}var Yl=class{element=X("section",{class:"legend","aria-label":"Legend"});title=X("h2",{});bar=X("canvas",{width:1,height:256,"aria-hidden":"true"});max;min;middle=X("span",{class:"middle"});lock;rows=X("ul",{class:"rows"});scale;palettes=new Map;limits;look;shown=[0,1];hasSpan=!1;extremes={age:60,uncertainty:2};constructor(e){this.look=e.value;let t=i=>s=>{let r=Number(s.target.value);if(!Number.isFinite(r))return this.draw();let o=ys(r,this.look.unit),[a,c]=i==="min_celsius"?[o,this.shown[1]]:[this.shown[0],o];c-a>=.1&&e.set({min_celsius:a,max_celsius:c,locked:!0,widens:!1}),this.draw()};this.max=X("input",{type:"number",step:"0.5","aria-label":"Highest temperature of the palette",onchange:t("max_celsius")}),this.min=X("input",{type:"number",step:"0.5","aria-label":"Lowest temperature of the palette",onchange:t("min_celsius")}),this.lock=X("button",{type:"button",class:"lock",onclick:()=>{e.value.locked?e.set({locked:!1}):e.set({locked:!0,widens:!1,min_celsius:this.shown[0],max_celsius:this.shown[1]})}}),this.scale=X("div",{class:"scale"},this.max,this.bar,this.middle,this.min,this.lock),this.element.append(this.title,this.scale,this.rows),e.onChange(i=>{this.look=i,this.draw()})}setPalettes(e){this.palettes=new Map(e.map(({name:t,colours:i})=>[t,i])),this.draw()}setLimits(e){this.limits=e,this.draw()}setSpan(e,t){this.hasSpan&&this.shown[0]===e&&this.shown[1]===t||(this.hasSpan=!0,this.shown=[e,t],this.draw())}setExtremes(e,t){this.extremes={age:e,uncertainty:t},this.draw()}draw(){let{layer:e,unit:t,locked:i,widens:s}=this.look;Pt(this.title,bs.find(([l])=>l===e)[1]);let r=e==="thermal"||e==="age"||e==="uncertainty";Vt(this.scale,r);let o=e==="thermal";this.max.disabled=this.min.disabled=!o,Vt(this.lock,o),Pt(this.lock,i?s?"Widens":"Fixed":"Auto"),this.lock.setAttribute("aria-pressed",String(i)),this.lock.title=i?`The span ${s?"only widens, in steps of 5 °C; type a limit to fix it":"is fixed"}. Press to let it follow the model.`:"The span follows the model. Press to fix it.",r&&this.drawBar();let a=(l,h)=>{document.activeElement!==l&&(l.value=h)};if(o){let[l,h]=this.shown.map(u=>jn(u,t));a(this.max,this.hasSpan?h.toFixed(1):""),a(this.min,this.hasSpan?l.toFixed(1):""),Pt(this.middle,this.hasSpan?`${((l+h)/2).toFixed(1)} ${Jn(t)}`:Jn(t))}else e==="age"?(a(this.max,this.extremes.age.toFixed(0)),a(this.min,"0"),Pt(this.middle,`${(this.extremes.age/2).toFixed(0)} s`)):e==="uncertainty"&&(a(this.max,kl(this.extremes.uncertainty,t).toFixed(1)),a(this.min,"0"),Pt(this.middle,`${kl(this.extremes.uncertainty/2,t).toFixed(2)} ${t==="fahrenheit"?"°F":"K"}`));let c=ab(this.look,this.limits);this.rows.replaceChildren(...c.map(([l,h,u])=>{let d=X("span",{class:"swatch"});return d.style.background=l,X("li",{},d,X("span",{},h,u===""?null:X("small",{},u)))})),Vt(this.rows,c.length>0)}drawBar(){let e=this.look.layer==="thermal",t=this.palettes.get(e?this.look.palette:"inferno"),i=this.bar.getContext("2d"),s=i.createImageData(1,256);for(let r=0;r<256;++r){let o=e?255-r:r;for(let a=0;a<3;++a)s.data[4*r+a]=t?.[3*o+a]??o;s.data[4*r+3]=255}i.putImageData(s,0,0)}};async function Rg(n){let e=await fetch("api/login",{method:"POST",body:n.trim()});return e.ok?"":(await e.text()).trim()}function lb(n){return new Promise(e=>{let t=X("input",{type:"text",autocomplete:"off",autocapitalize:"off",spellcheck:!1,id:"code",required:!0}),i=X("p",{class:"why",role:"alert"}),s=X("form",{class:"login"},X("img",{src:"icon.svg",alt:"",width:72,height:72}),X("h1",{},"Isotherm"),X("label",{for:"code"},"The code that the ground service shows"),t,X("button",{type:"submit",class:"primary"},"Come in"),i);s.addEventListener("submit",r=>{r.preventDefault(),Rg(t.value).then(o=>{o===""?(s.remove(),e()):Pt(i,o)})}),n.append(s),t.focus()})}async function Cg(n){let e=new URLSearchParams(location.hash.slice(1)).get("code");if(!(e!==null&&(history.replaceState(null,"",location.pathname),await Rg(e)==="")))for(;;)try{return(await fetch("api/scan")).status!==401?void 0:await lb(n)}catch{await new Promise(t=>setTimeout(t,1e3))}}var or={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},ar={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},r0=0,Xd=1,o0=2;var za=1,a0=2,Co=3,lr=0,$n=1,Ri=2,Cr=0,Io=1,Yd=2,Zd=3,Kd=4,l0=5;var Ir=100,c0=101,u0=102,h0=103,d0=104,f0=200,p0=201,m0=202,g0=203,$d=204,qd=205,_0=206,y0=207,x0=208,v0=209,b0=210,S0=211,M0=212,E0=213,A0=214,bc=0,Sc=1,Mc=2,vo=3,Ec=4,Ac=5,Tc=6,wc=7,Jd=0,T0=1,w0=2,rs=0,jd=1,Qd=2,ef=3,tf=4,nf=5,sf=6,rf=7;var of=300,Nr=301,No=302,eu=303,tu=304,Rc=1e3,is=1001,Cc=1002,Pn=1003,R0=1004;var Ha=1005;var Fn=1006,nu=1007;var Ps=1008;var pi=1009,af=1010,lf=1011,Po=1012,iu=1013,zi=1014,mi=1015,Hi=1016,su=1017,ru=1018,Pr=1020,cf=35902,uf=35899,hf=1021,df=1022,Wi=1023,Cs=1026,Ls=1027,Wa=1028,ou=1029,cr=1030,au=1031;var lu=1033,Xa=33776,Ya=33777,Za=33778,Ka=33779,cu=35840,uu=35841,hu=35842,du=35843,fu=36196,pu=37492,mu=37496,gu=37488,_u=37489,$a=37490,yu=37491,xu=37808,vu=37809,bu=37810,Su=37811,Mu=37812,Eu=37813,Au=37814,Tu=37815,wu=37816,Ru=37817,Cu=37818,Iu=37819,Nu=37820,Pu=37821,Lu=36492,Du=36494,Fu=36495,Uu=36283,Ou=36284,qa=36285,Bu=36286;var Sa=2300,Ic=2301,xc=2302,Bd=2303,kd=2400,Gd=2401,Vd=2402;var C0=3200;var ff=0,I0=1,Ds="",li="srgb",Ar="srgb-linear",Ma="linear",wt="srgb";var vc=7680;var N0=519,P0=512,L0=513,D0=514,pf=515,F0=516,U0=517,mf=518,gf=519,O0=35044;var Ja="300 es",Ti=2e3,Ea=2001;function cb(n){for(let e=n.length-1;e>=0;--e)if(n[e]>=65535)return!0;return!1}function ub(n){return ArrayBuffer.isView(n)&&!(n instanceof DataView)}function Aa(n){return document.createElementNS("http://www.w3.org/1999/xhtml",n)}function B0(){let n=Aa("canvas");return n.style.display="block",n}var Ig={},bo=null;function _f(...n){let e="THREE."+n.shift();bo?bo("log",e,...n):console.log(e,...n)}function k0(n){let e=n[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=n[1];t&&t.isStackTrace?n[0]+=" "+t.getLocation():n[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return n}function Ze(...n){n=k0(n);let e="THREE."+n.shift();if(bo)bo("warn",e,...n);else{let t=n[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...n)}}function Qe(...n){n=k0(n);let e="THREE."+n.shift();if(bo)bo("error",e,...n);else{let t=n[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...n)}}function va(...n){let e=n.join(" ");e in Ig||(Ig[e]=!0,Ze(...n))}function G0(n,e,t){return new Promise(function(i,s){function r(){switch(n.clientWaitSync(e,n.SYNC_FLUSH_COMMANDS_BIT,0)){case n.WAIT_FAILED:s();break;case n.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:i()}}setTimeout(r,t)})}var V0={[bc]:bc,[Mc]:Tc,[Ec]:Ec,[vo]:Ac,[Sc]:Sc,[Tc]:Mc,[wc]:wc,[Ac]:vo},Vi=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let i=this._listeners;i[e]===void 0&&(i[e]=[]),i[e].indexOf(t)===-1&&i[e].push(t)}hasEventListener(e,t){let i=this._listeners;return i===void 0?!1:i[e]!==void 0&&i[e].indexOf(t)!==-1}removeEventListener(e,t){let i=this._listeners;if(i===void 0)return;let s=i[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let i=t[e.type];if(i!==void 0){e.target=this;let s=i.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}},kn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Ng=1234567,yo=Math.PI/180,So=180/Math.PI;function Lo(){let n=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,i=Math.random()*4294967295|0;return(kn[n&255]+kn[n>>8&255]+kn[n>>16&255]+kn[n>>24&255]+"-"+kn[e&255]+kn[e>>8&255]+"-"+kn[e>>16&15|64]+kn[e>>24&255]+"-"+kn[t&63|128]+kn[t>>8&255]+"-"+kn[t>>16&255]+kn[t>>24&255]+kn[i&255]+kn[i>>8&255]+kn[i>>16&255]+kn[i>>24&255]).toLowerCase()}function ft(n,e,t){return Math.max(e,Math.min(t,n))}function yf(n,e){return(n%e+e)%e}function hb(n,e,t,i,s){return i+(n-e)*(s-i)/(t-e)}function db(n,e,t){return n!==e?(t-n)/(e-n):0}function ba(n,e,t){return(1-t)*n+t*e}function fb(n,e,t,i){return ba(n,e,1-Math.exp(-t*i))}function pb(n,e=1){return e-Math.abs(yf(n,e*2)-e)}function mb(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*(3-2*n))}function gb(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*n*(n*(n*6-15)+10))}function _b(n,e){return n+Math.floor(Math.random()*(e-n+1))}function yb(n,e){return n+Math.random()*(e-n)}function xb(n){return n*(.5-Math.random())}function vb(n){n!==void 0&&(Ng=n);let e=Ng+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function bb(n){return n*yo}function Sb(n){return n*So}function Mb(n){return n>0&&Number.isInteger(n)&&2**Math.round(Math.log2(n))===n}function Eb(n){return Math.pow(2,Math.ceil(Math.log(n)/Math.LN2))}function xf(n){return Math.pow(2,Math.floor(Math.log(n)/Math.LN2))}function Ab(n,e,t,i,s){let r=Math.cos,o=Math.sin,a=r(t/2),c=o(t/2),l=r((e+i)/2),h=o((e+i)/2),u=r((e-i)/2),d=o((e-i)/2),f=r((i-e)/2),g=o((i-e)/2);switch(s){case"XYX":n.set(a*h,c*u,c*d,a*l);break;case"YZY":n.set(c*d,a*h,c*u,a*l);break;case"ZXZ":n.set(c*u,c*d,a*h,a*l);break;case"XZX":n.set(a*h,c*g,c*f,a*l);break;case"YXY":n.set(c*f,a*h,c*g,a*l);break;case"ZYZ":n.set(c*g,c*f,a*h,a*l);break;default:Ze("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function vf(n){switch(n.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function z0(n,e){if(e.constructor===Float32Array)return n;let t=vf(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(n/t,-1)}function H0(n,e){if(e.constructor===Float32Array)return n;let t=vf(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(n*t)}var bf={DEG2RAD:yo,RAD2DEG:So,generateUUID:Lo,clamp:ft,euclideanModulo:yf,mapLinear:hb,inverseLerp:db,lerp:ba,damp:fb,pingpong:pb,smoothstep:mb,smootherstep:gb,randInt:_b,randFloat:yb,randFloatSpread:xb,seededRandom:vb,degToRad:bb,radToDeg:Sb,isPowerOfTwo:Mb,ceilPowerOfTwo:Eb,floorPowerOfTwo:xf,setQuaternionFromProperEuler:Ab,normalize:H0,denormalize:z0},$e=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,i=this.y,s=e.elements;return this.x=s[0]*t+s[3]*i+s[6],this.y=s[1]*t+s[4]*i+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=ft(this.x,e.x,t.x),this.y=ft(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=ft(this.x,e,t),this.y=ft(this.y,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(ft(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(ft(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y;return t*t+i*i}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let i=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*i-o*s+e.x,this.y=r*s+o*i+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},Kn=class{constructor(e=0,t=0,i=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=i,this._w=s}static slerpFlat(e,t,i,s,r,o,a){let c=i[s+0],l=i[s+1],h=i[s+2],u=i[s+3],d=r[o+0],f=r[o+1],g=r[o+2],v=r[o+3];if(u!==v||c!==d||l!==f||h!==g){let p=c*d+l*f+h*g+u*v;p<0&&(d=-d,f=-f,g=-g,v=-v,p=-p);let m=1-a;if(p<.9995){let b=Math.acos(p),C=Math.sin(b);m=Math.sin(m*b)/C,a=Math.sin(a*b)/C,c=c*m+d*a,l=l*m+f*a,h=h*m+g*a,u=u*m+v*a}else{c=c*m+d*a,l=l*m+f*a,h=h*m+g*a,u=u*m+v*a;let b=1/Math.sqrt(c*c+l*l+h*h+u*u);c*=b,l*=b,h*=b,u*=b}}e[t]=c,e[t+1]=l,e[t+2]=h,e[t+3]=u}static multiplyQuaternionsFlat(e,t,i,s,r,o){let a=i[s],c=i[s+1],l=i[s+2],h=i[s+3],u=r[o],d=r[o+1],f=r[o+2],g=r[o+3];return e[t]=a*g+h*u+c*f-l*d,e[t+1]=c*g+h*d+l*u-a*f,e[t+2]=l*g+h*f+a*d-c*u,e[t+3]=h*g-a*u-c*d-l*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,i,s){return this._x=e,this._y=t,this._z=i,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let i=e._x,s=e._y,r=e._z,o=e._order,a=Math.cos,c=Math.sin,l=a(i/2),h=a(s/2),u=a(r/2),d=c(i/2),f=c(s/2),g=c(r/2);switch(o){case"XYZ":this._x=d*h*u+l*f*g,this._y=l*f*u-d*h*g,this._z=l*h*g+d*f*u,this._w=l*h*u-d*f*g;break;case"YXZ":this._x=d*h*u+l*f*g,this._y=l*f*u-d*h*g,this._z=l*h*g-d*f*u,this._w=l*h*u+d*f*g;break;case"ZXY":this._x=d*h*u-l*f*g,this._y=l*f*u+d*h*g,this._z=l*h*g+d*f*u,this._w=l*h*u-d*f*g;break;case"ZYX":this._x=d*h*u-l*f*g,this._y=l*f*u+d*h*g,this._z=l*h*g-d*f*u,this._w=l*h*u+d*f*g;break;case"YZX":this._x=d*h*u+l*f*g,this._y=l*f*u+d*h*g,this._z=l*h*g-d*f*u,this._w=l*h*u-d*f*g;break;case"XZY":this._x=d*h*u-l*f*g,this._y=l*f*u-d*h*g,this._z=l*h*g+d*f*u,this._w=l*h*u+d*f*g;break;default:Ze("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let i=t/2,s=Math.sin(i);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(i),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,i=t[0],s=t[4],r=t[8],o=t[1],a=t[5],c=t[9],l=t[2],h=t[6],u=t[10],d=i+a+u;if(d>0){let f=.5/Math.sqrt(d+1);this._w=.25/f,this._x=(h-c)*f,this._y=(r-l)*f,this._z=(o-s)*f}else if(i>a&&i>u){let f=2*Math.sqrt(1+i-a-u);this._w=(h-c)/f,this._x=.25*f,this._y=(s+o)/f,this._z=(r+l)/f}else if(a>u){let f=2*Math.sqrt(1+a-i-u);this._w=(r-l)/f,this._x=(s+o)/f,this._y=.25*f,this._z=(c+h)/f}else{let f=2*Math.sqrt(1+u-i-a);this._w=(o-s)/f,this._x=(r+l)/f,this._y=(c+h)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let i=e.dot(t)+1;return i<1e-8?(i=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=i):(this._x=0,this._y=-e.z,this._z=e.y,this._w=i)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=i),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(ft(this.dot(e),-1,1)))}rotateTowards(e,t){let i=this.angleTo(e);if(i===0)return this;let s=Math.min(1,t/i);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=t._x,c=t._y,l=t._z,h=t._w;return this._x=i*h+o*a+s*l-r*c,this._y=s*h+o*c+r*a-i*l,this._z=r*h+o*l+i*c-s*a,this._w=o*h-i*a-s*c-r*l,this._onChangeCallback(),this}slerp(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=this.dot(e);a<0&&(i=-i,s=-s,r=-r,o=-o,a=-a);let c=1-t;if(a<.9995){let l=Math.acos(a),h=Math.sin(l);c=Math.sin(c*l)/h,t=Math.sin(t*l)/h,this._x=this._x*c+i*t,this._y=this._y*c+s*t,this._z=this._z*c+r*t,this._w=this._w*c+o*t,this._onChangeCallback()}else this._x=this._x*c+i*t,this._y=this._y*c+s*t,this._z=this._z*c+r*t,this._w=this._w*c+o*t,this.normalize();return this}slerpQuaternions(e,t,i){return this.copy(e).slerp(t,i)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),i=Math.random(),s=Math.sqrt(1-i),r=Math.sqrt(i);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},H=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,i=0){this.x=e,this.y=t,this.z=i}set(e,t,i){return i===void 0&&(i=this.z),this.x=e,this.y=t,this.z=i,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(Pg.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(Pg.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*i+r[6]*s,this.y=r[1]*t+r[4]*i+r[7]*s,this.z=r[2]*t+r[5]*i+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*i+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*i+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*i+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*i+r[10]*s+r[14])*o,this}applyQuaternion(e){let t=this.x,i=this.y,s=this.z,r=e.x,o=e.y,a=e.z,c=e.w,l=2*(o*s-a*i),h=2*(a*t-r*s),u=2*(r*i-o*t);return this.x=t+c*l+o*u-a*h,this.y=i+c*h+a*l-r*u,this.z=s+c*u+r*h-o*l,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*i+r[8]*s,this.y=r[1]*t+r[5]*i+r[9]*s,this.z=r[2]*t+r[6]*i+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=ft(this.x,e.x,t.x),this.y=ft(this.y,e.y,t.y),this.z=ft(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=ft(this.x,e,t),this.y=ft(this.y,e,t),this.z=ft(this.z,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(ft(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let i=e.x,s=e.y,r=e.z,o=t.x,a=t.y,c=t.z;return this.x=s*c-r*a,this.y=r*o-i*c,this.z=i*a-s*o,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let i=e.dot(this)/t;return this.copy(e).multiplyScalar(i)}projectOnPlane(e){return gd.copy(this).projectOnVector(e),this.sub(gd)}reflect(e){return this.sub(gd.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(ft(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y,s=this.z-e.z;return t*t+i*i+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,i){let s=Math.sin(t)*e;return this.x=s*Math.sin(i),this.y=Math.cos(t)*e,this.z=s*Math.cos(i),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,i){return this.x=e*Math.sin(t),this.y=i,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),i=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=i,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,i=Math.sqrt(1-t*t);return this.x=i*Math.cos(e),this.y=t,this.z=i*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},gd=new H,Pg=new Kn,tt=class{static{this.prototype.isMatrix3=!0}constructor(e,t,i,s,r,o,a,c,l){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,c,l)}set(e,t,i,s,r,o,a,c,l){let h=this.elements;return h[0]=e,h[1]=s,h[2]=a,h[3]=t,h[4]=r,h[5]=c,h[6]=i,h[7]=o,h[8]=l,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],this}extractBasis(e,t,i){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),i.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[3],c=i[6],l=i[1],h=i[4],u=i[7],d=i[2],f=i[5],g=i[8],v=s[0],p=s[3],m=s[6],b=s[1],C=s[4],E=s[7],I=s[2],T=s[5],y=s[8];return r[0]=o*v+a*b+c*I,r[3]=o*p+a*C+c*T,r[6]=o*m+a*E+c*y,r[1]=l*v+h*b+u*I,r[4]=l*p+h*C+u*T,r[7]=l*m+h*E+u*y,r[2]=d*v+f*b+g*I,r[5]=d*p+f*C+g*T,r[8]=d*m+f*E+g*y,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],c=e[6],l=e[7],h=e[8];return t*o*h-t*a*l-i*r*h+i*a*c+s*r*l-s*o*c}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],c=e[6],l=e[7],h=e[8],u=h*o-a*l,d=a*c-h*r,f=l*r-o*c,g=t*u+i*d+s*f;if(g===0)return this.set(0,0,0,0,0,0,0,0,0);let v=1/g;return e[0]=u*v,e[1]=(s*l-h*i)*v,e[2]=(a*i-s*o)*v,e[3]=d*v,e[4]=(h*t-s*c)*v,e[5]=(s*r-a*t)*v,e[6]=f*v,e[7]=(i*c-l*t)*v,e[8]=(o*t-i*r)*v,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,i,s,r,o,a){let c=Math.cos(r),l=Math.sin(r);return this.set(i*c,i*l,-i*(c*o+l*a)+o+e,-s*l,s*c,-s*(-l*o+c*a)+a+t,0,0,1),this}scale(e,t){return va("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(_d.makeScale(e,t)),this}rotate(e){return va("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(_d.makeRotation(-e)),this}translate(e,t){return va("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(_d.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,i,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<9;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<9;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e}clone(){return new this.constructor().fromArray(this.elements)}},_d=new tt,Lg=new tt().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Dg=new tt().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Tb(){let n={enabled:!0,workingColorSpace:Ar,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===wt&&(s.r=Rs(s.r),s.g=Rs(s.g),s.b=Rs(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===wt&&(s.r=xo(s.r),s.g=xo(s.g),s.b=xo(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Ds?Ma:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],i=[.3127,.329];return n.define({[Ar]:{primaries:e,whitePoint:i,transfer:Ma,toXYZ:Lg,fromXYZ:Dg,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:li},outputColorSpaceConfig:{drawingBufferColorSpace:li}},[li]:{primaries:e,whitePoint:i,transfer:wt,toXYZ:Lg,fromXYZ:Dg,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:li}}}),n}var gt=Tb();function Rs(n){return n<.04045?n*.0773993808:Math.pow(n*.9478672986+.0521327014,2.4)}function xo(n){return n<.0031308?n*12.92:1.055*Math.pow(n,.41666)-.055}var so,Nc=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let i;if(e instanceof HTMLCanvasElement)i=e;else{so===void 0&&(so=Aa("canvas")),so.width=e.width,so.height=e.height;let s=so.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),i=so}return i.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=Aa("canvas");t.width=e.width,t.height=e.height;let i=t.getContext("2d");i.drawImage(e,0,0,e.width,e.height);let s=i.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Rs(r[o]/255)*255;return i.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let i=0;i<t.length;i++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[i]=Math.floor(Rs(t[i]/255)*255):t[i]=Rs(t[i]);return{data:t,width:e.width,height:e.height}}else return Ze("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},wb=0,Mo=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:wb++}),this.uuid=Lo(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let i={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(yd(s[o].image)):r.push(yd(s[o]))}else r=yd(s);i.url=r}return t||(e.images[this.uuid]=i),i}};function yd(n){return typeof HTMLImageElement<"u"&&n instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&n instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&n instanceof ImageBitmap?Nc.getDataURL(n):n.data?{data:Array.from(n.data),width:n.width,height:n.height,type:n.data.constructor.name}:(Ze("Texture: Unable to serialize Texture."),{})}var Rb=0,xd=new H,Qn=class n extends Vi{constructor(e=n.DEFAULT_IMAGE,t=n.DEFAULT_MAPPING,i=is,s=is,r=Fn,o=Ps,a=Wi,c=pi,l=n.DEFAULT_ANISOTROPY,h=Ds){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Rb++}),this.uuid=Lo(),this.name="",this.source=new Mo(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=i,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=l,this.format=a,this.internalFormat=null,this.type=c,this.offset=new $e(0,0),this.repeat=new $e(1,1),this.center=new $e(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new tt,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(xd).x}get height(){return this.source.getSize(xd).y}get depth(){return this.source.getSize(xd).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let i=e[t];if(i===void 0){Ze(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ze(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&i&&s.isVector2&&i.isVector2||s&&i&&s.isVector3&&i.isVector3||s&&i&&s.isMatrix3&&i.isMatrix3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let i={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(i.userData=this.userData),t||(e.textures[this.uuid]=i),i}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==of)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Rc:e.x=e.x-Math.floor(e.x);break;case is:e.x=e.x<0?0:1;break;case Cc:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Rc:e.y=e.y-Math.floor(e.y);break;case is:e.y=e.y<0?0:1;break;case Cc:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};Qn.DEFAULT_IMAGE=null;Qn.DEFAULT_MAPPING=of;Qn.DEFAULT_ANISOTROPY=1;var Jt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,i=0,s=1){this.x=e,this.y=t,this.z=i,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,i,s){return this.x=e,this.y=t,this.z=i,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*i+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*i+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*i+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*i+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,i,s,r,c=e.elements,l=c[0],h=c[4],u=c[8],d=c[1],f=c[5],g=c[9],v=c[2],p=c[6],m=c[10];if(Math.abs(h-d)<.01&&Math.abs(u-v)<.01&&Math.abs(g-p)<.01){if(Math.abs(h+d)<.1&&Math.abs(u+v)<.1&&Math.abs(g+p)<.1&&Math.abs(l+f+m-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let C=(l+1)/2,E=(f+1)/2,I=(m+1)/2,T=(h+d)/4,y=(u+v)/4,A=(g+p)/4;return C>E&&C>I?C<.01?(i=0,s=.707106781,r=.707106781):(i=Math.sqrt(C),s=T/i,r=y/i):E>I?E<.01?(i=.707106781,s=0,r=.707106781):(s=Math.sqrt(E),i=T/s,r=A/s):I<.01?(i=.707106781,s=.707106781,r=0):(r=Math.sqrt(I),i=y/r,s=A/r),this.set(i,s,r,t),this}let b=Math.sqrt((p-g)*(p-g)+(u-v)*(u-v)+(d-h)*(d-h));return Math.abs(b)<.001&&(b=1),this.x=(p-g)/b,this.y=(u-v)/b,this.z=(d-h)/b,this.w=Math.acos((l+f+m-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=ft(this.x,e.x,t.x),this.y=ft(this.y,e.y,t.y),this.z=ft(this.z,e.z,t.z),this.w=ft(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=ft(this.x,e,t),this.y=ft(this.y,e,t),this.z=ft(this.z,e,t),this.w=ft(this.w,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(ft(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this.w=e.w+(t.w-e.w)*i,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Pc=class extends Vi{constructor(e=1,t=1,i={}){super(),i=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Fn,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},i),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=i.depth,this.scissor=new Jt(0,0,e,t),this.scissorTest=!1,this.viewport=new Jt(0,0,e,t),this.textures=[];let s=i.count;for(let r=0;r<s;r++)this.textures[r]=new Qn({width:e,height:t,depth:i.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(i),this.depthBuffer=i.depthBuffer,this.stencilBuffer=i.stencilBuffer,this.resolveColorBuffer=i.resolveColorBuffer,this.resolveDepthBuffer=i.resolveDepthBuffer,this.resolveStencilBuffer=i.resolveStencilBuffer,this.storeMultisampledColorBuffer=i.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=i.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=i.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=i.depthTexture,this.samples=i.samples,this.multiview=i.multiview,this.useArrayDepthTexture=i.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:Fn,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let i=0;i<this.textures.length;i++)this.textures[i].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,i=1){if(this.width!==e||this.height!==t||this.depth!==i){this.width=e,this.height=t,this.depth=i;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=i,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,i=e.textures.length;t<i;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new Mo(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},hi=class extends Pc{constructor(e=1,t=1,i={}){super(e,t,i),this.isWebGLRenderTarget=!0}},Ta=class extends Qn{constructor(e=null,t=1,i=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=Pn,this.minFilter=Pn,this.wrapR=is,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var Lc=class extends Qn{constructor(e=null,t=1,i=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=Pn,this.minFilter=Pn,this.wrapR=is,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var Ft=class n{static{this.prototype.isMatrix4=!0}constructor(e,t,i,s,r,o,a,c,l,h,u,d,f,g,v,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,c,l,h,u,d,f,g,v,p)}set(e,t,i,s,r,o,a,c,l,h,u,d,f,g,v,p){let m=this.elements;return m[0]=e,m[4]=t,m[8]=i,m[12]=s,m[1]=r,m[5]=o,m[9]=a,m[13]=c,m[2]=l,m[6]=h,m[10]=u,m[14]=d,m[3]=f,m[7]=g,m[11]=v,m[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new n().fromArray(this.elements)}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],t[9]=i[9],t[10]=i[10],t[11]=i[11],t[12]=i[12],t[13]=i[13],t[14]=i[14],t[15]=i[15],this}copyPosition(e){let t=this.elements,i=e.elements;return t[12]=i[12],t[13]=i[13],t[14]=i[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,i){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),i.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),i.setFromMatrixColumn(this,2),this)}makeBasis(e,t,i){return this.set(e.x,t.x,i.x,0,e.y,t.y,i.y,0,e.z,t.z,i.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,i=e.elements,s=1/ro.setFromMatrixColumn(e,0).length(),r=1/ro.setFromMatrixColumn(e,1).length(),o=1/ro.setFromMatrixColumn(e,2).length();return t[0]=i[0]*s,t[1]=i[1]*s,t[2]=i[2]*s,t[3]=0,t[4]=i[4]*r,t[5]=i[5]*r,t[6]=i[6]*r,t[7]=0,t[8]=i[8]*o,t[9]=i[9]*o,t[10]=i[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,i=e.x,s=e.y,r=e.z,o=Math.cos(i),a=Math.sin(i),c=Math.cos(s),l=Math.sin(s),h=Math.cos(r),u=Math.sin(r);if(e.order==="XYZ"){let d=o*h,f=o*u,g=a*h,v=a*u;t[0]=c*h,t[4]=-c*u,t[8]=l,t[1]=f+g*l,t[5]=d-v*l,t[9]=-a*c,t[2]=v-d*l,t[6]=g+f*l,t[10]=o*c}else if(e.order==="YXZ"){let d=c*h,f=c*u,g=l*h,v=l*u;t[0]=d+v*a,t[4]=g*a-f,t[8]=o*l,t[1]=o*u,t[5]=o*h,t[9]=-a,t[2]=f*a-g,t[6]=v+d*a,t[10]=o*c}else if(e.order==="ZXY"){let d=c*h,f=c*u,g=l*h,v=l*u;t[0]=d-v*a,t[4]=-o*u,t[8]=g+f*a,t[1]=f+g*a,t[5]=o*h,t[9]=v-d*a,t[2]=-o*l,t[6]=a,t[10]=o*c}else if(e.order==="ZYX"){let d=o*h,f=o*u,g=a*h,v=a*u;t[0]=c*h,t[4]=g*l-f,t[8]=d*l+v,t[1]=c*u,t[5]=v*l+d,t[9]=f*l-g,t[2]=-l,t[6]=a*c,t[10]=o*c}else if(e.order==="YZX"){let d=o*c,f=o*l,g=a*c,v=a*l;t[0]=c*h,t[4]=v-d*u,t[8]=g*u+f,t[1]=u,t[5]=o*h,t[9]=-a*h,t[2]=-l*h,t[6]=f*u+g,t[10]=d-v*u}else if(e.order==="XZY"){let d=o*c,f=o*l,g=a*c,v=a*l;t[0]=c*h,t[4]=-u,t[8]=l*h,t[1]=d*u+v,t[5]=o*h,t[9]=f*u-g,t[2]=g*u-f,t[6]=a*h,t[10]=v*u+d}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Cb,e,Ib)}lookAt(e,t,i){let s=this.elements;return oi.subVectors(e,t),oi.lengthSq()===0&&(oi.z=1),oi.normalize(),Zs.crossVectors(i,oi),Zs.lengthSq()===0&&(Math.abs(i.z)===1?oi.x+=1e-4:oi.z+=1e-4,oi.normalize(),Zs.crossVectors(i,oi)),Zs.normalize(),Zl.crossVectors(oi,Zs),s[0]=Zs.x,s[4]=Zl.x,s[8]=oi.x,s[1]=Zs.y,s[5]=Zl.y,s[9]=oi.y,s[2]=Zs.z,s[6]=Zl.z,s[10]=oi.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[4],c=i[8],l=i[12],h=i[1],u=i[5],d=i[9],f=i[13],g=i[2],v=i[6],p=i[10],m=i[14],b=i[3],C=i[7],E=i[11],I=i[15],T=s[0],y=s[4],A=s[8],B=s[12],D=s[1],L=s[5],k=s[9],z=s[13],P=s[2],W=s[6],K=s[10],V=s[14],ue=s[3],j=s[7],ee=s[11],re=s[15];return r[0]=o*T+a*D+c*P+l*ue,r[4]=o*y+a*L+c*W+l*j,r[8]=o*A+a*k+c*K+l*ee,r[12]=o*B+a*z+c*V+l*re,r[1]=h*T+u*D+d*P+f*ue,r[5]=h*y+u*L+d*W+f*j,r[9]=h*A+u*k+d*K+f*ee,r[13]=h*B+u*z+d*V+f*re,r[2]=g*T+v*D+p*P+m*ue,r[6]=g*y+v*L+p*W+m*j,r[10]=g*A+v*k+p*K+m*ee,r[14]=g*B+v*z+p*V+m*re,r[3]=b*T+C*D+E*P+I*ue,r[7]=b*y+C*L+E*W+I*j,r[11]=b*A+C*k+E*K+I*ee,r[15]=b*B+C*z+E*V+I*re,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[12],o=e[1],a=e[5],c=e[9],l=e[13],h=e[2],u=e[6],d=e[10],f=e[14],g=e[3],v=e[7],p=e[11],m=e[15],b=c*f-l*d,C=a*f-l*u,E=a*d-c*u,I=o*f-l*h,T=o*d-c*h,y=o*u-a*h;return t*(v*b-p*C+m*E)-i*(g*b-p*I+m*T)+s*(g*C-v*I+m*y)-r*(g*E-v*T+p*y)}determinantAffine(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[1],o=e[5],a=e[9],c=e[2],l=e[6],h=e[10];return t*(o*h-a*l)-i*(r*h-a*c)+s*(r*l-o*c)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,i){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=i),this}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],c=e[6],l=e[7],h=e[8],u=e[9],d=e[10],f=e[11],g=e[12],v=e[13],p=e[14],m=e[15],b=t*a-i*o,C=t*c-s*o,E=t*l-r*o,I=i*c-s*a,T=i*l-r*a,y=s*l-r*c,A=h*v-u*g,B=h*p-d*g,D=h*m-f*g,L=u*p-d*v,k=u*m-f*v,z=d*m-f*p,P=b*z-C*k+E*L+I*D-T*B+y*A;if(P===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let W=1/P;return e[0]=(a*z-c*k+l*L)*W,e[1]=(s*k-i*z-r*L)*W,e[2]=(v*y-p*T+m*I)*W,e[3]=(d*T-u*y-f*I)*W,e[4]=(c*D-o*z-l*B)*W,e[5]=(t*z-s*D+r*B)*W,e[6]=(p*E-g*y-m*C)*W,e[7]=(h*y-d*E+f*C)*W,e[8]=(o*k-a*D+l*A)*W,e[9]=(i*D-t*k-r*A)*W,e[10]=(g*T-v*E+m*b)*W,e[11]=(u*E-h*T-f*b)*W,e[12]=(a*B-o*L-c*A)*W,e[13]=(t*L-i*B+s*A)*W,e[14]=(v*C-g*I-p*b)*W,e[15]=(h*I-u*C+d*b)*W,this}scale(e){let t=this.elements,i=e.x,s=e.y,r=e.z;return t[0]*=i,t[4]*=s,t[8]*=r,t[1]*=i,t[5]*=s,t[9]*=r,t[2]*=i,t[6]*=s,t[10]*=r,t[3]*=i,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],i=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,i,s))}makeTranslation(e,t,i){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,i,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),i=Math.sin(e);return this.set(1,0,0,0,0,t,-i,0,0,i,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,0,i,0,0,1,0,0,-i,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,0,i,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let i=Math.cos(t),s=Math.sin(t),r=1-i,o=e.x,a=e.y,c=e.z,l=r*o,h=r*a;return this.set(l*o+i,l*a-s*c,l*c+s*a,0,l*a+s*c,h*a+i,h*c-s*o,0,l*c-s*a,h*c+s*o,r*c*c+i,0,0,0,0,1),this}makeScale(e,t,i){return this.set(e,0,0,0,0,t,0,0,0,0,i,0,0,0,0,1),this}makeShear(e,t,i,s,r,o){return this.set(1,i,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,i){let s=this.elements,r=t._x,o=t._y,a=t._z,c=t._w,l=r+r,h=o+o,u=a+a,d=r*l,f=r*h,g=r*u,v=o*h,p=o*u,m=a*u,b=c*l,C=c*h,E=c*u,I=i.x,T=i.y,y=i.z;return s[0]=(1-(v+m))*I,s[1]=(f+E)*I,s[2]=(g-C)*I,s[3]=0,s[4]=(f-E)*T,s[5]=(1-(d+m))*T,s[6]=(p+b)*T,s[7]=0,s[8]=(g+C)*y,s[9]=(p-b)*y,s[10]=(1-(d+v))*y,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,i){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return i.set(1,1,1),t.identity(),this;let o=ro.set(s[0],s[1],s[2]).length(),a=ro.set(s[4],s[5],s[6]).length(),c=ro.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Bi.copy(this);let l=1/o,h=1/a,u=1/c;return Bi.elements[0]*=l,Bi.elements[1]*=l,Bi.elements[2]*=l,Bi.elements[4]*=h,Bi.elements[5]*=h,Bi.elements[6]*=h,Bi.elements[8]*=u,Bi.elements[9]*=u,Bi.elements[10]*=u,t.setFromRotationMatrix(Bi),i.x=o,i.y=a,i.z=c,this}makePerspective(e,t,i,s,r,o,a=Ti,c=!1){let l=this.elements,h=2*r/(t-e),u=2*r/(i-s),d=(t+e)/(t-e),f=(i+s)/(i-s),g,v;if(c)g=r/(o-r),v=o*r/(o-r);else if(a===Ti)g=-(o+r)/(o-r),v=-2*o*r/(o-r);else if(a===Ea)g=-o/(o-r),v=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return l[0]=h,l[4]=0,l[8]=d,l[12]=0,l[1]=0,l[5]=u,l[9]=f,l[13]=0,l[2]=0,l[6]=0,l[10]=g,l[14]=v,l[3]=0,l[7]=0,l[11]=-1,l[15]=0,this}makeOrthographic(e,t,i,s,r,o,a=Ti,c=!1){let l=this.elements,h=2/(t-e),u=2/(i-s),d=-(t+e)/(t-e),f=-(i+s)/(i-s),g,v;if(c)g=1/(o-r),v=o/(o-r);else if(a===Ti)g=-2/(o-r),v=-(o+r)/(o-r);else if(a===Ea)g=-1/(o-r),v=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return l[0]=h,l[4]=0,l[8]=0,l[12]=d,l[1]=0,l[5]=u,l[9]=0,l[13]=f,l[2]=0,l[6]=0,l[10]=g,l[14]=v,l[3]=0,l[7]=0,l[11]=0,l[15]=1,this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<16;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<16;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e[t+9]=i[9],e[t+10]=i[10],e[t+11]=i[11],e[t+12]=i[12],e[t+13]=i[13],e[t+14]=i[14],e[t+15]=i[15],e}},ro=new H,Bi=new Ft,Cb=new H(0,0,0),Ib=new H(1,1,1),Zs=new H,Zl=new H,oi=new H,Fg=new Ft,Ug=new Kn,js=class n{constructor(e=0,t=0,i=0,s=n.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=i,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,i,s=this._order){return this._x=e,this._y=t,this._z=i,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,i=!0){let s=e.elements,r=s[0],o=s[4],a=s[8],c=s[1],l=s[5],h=s[9],u=s[2],d=s[6],f=s[10];switch(t){case"XYZ":this._y=Math.asin(ft(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-h,f),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(d,l),this._z=0);break;case"YXZ":this._x=Math.asin(-ft(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(a,f),this._z=Math.atan2(c,l)):(this._y=Math.atan2(-u,r),this._z=0);break;case"ZXY":this._x=Math.asin(ft(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-o,l)):(this._y=0,this._z=Math.atan2(c,r));break;case"ZYX":this._y=Math.asin(-ft(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(c,r)):(this._x=0,this._z=Math.atan2(-o,l));break;case"YZX":this._z=Math.asin(ft(c,-1,1)),Math.abs(c)<.9999999?(this._x=Math.atan2(-h,l),this._y=Math.atan2(-u,r)):(this._x=0,this._y=Math.atan2(a,f));break;case"XZY":this._z=Math.asin(-ft(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(d,l),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-h,f),this._y=0);break;default:Ze("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,i===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,i){return Fg.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Fg,t,i)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Ug.setFromEuler(this),this.setFromQuaternion(Ug,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};js.DEFAULT_ORDER="XYZ";var Eo=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},Nb=0,Og=new H,oo=new Kn,Ss=new Ft,Kl=new H,ma=new H,Pb=new H,Lb=new Kn,Bg=new H(1,0,0),kg=new H(0,1,0),Gg=new H(0,0,1),Vg={type:"added"},Db={type:"removed"},ao={type:"childadded",child:null},vd={type:"childremoved",child:null},ei=class n extends Vi{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Nb++}),this.uuid=Lo(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=n.DEFAULT_UP.clone();let e=new H,t=new js,i=new Kn,s=new H(1,1,1);function r(){i.setFromEuler(t,!1)}function o(){t.setFromQuaternion(i,void 0,!1)}t._onChange(r),i._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:i},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Ft},normalMatrix:{value:new tt}}),this.matrix=new Ft,this.matrixWorld=new Ft,this.matrixAutoUpdate=n.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=n.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Eo,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return oo.setFromAxisAngle(e,t),this.quaternion.multiply(oo),this}rotateOnWorldAxis(e,t){return oo.setFromAxisAngle(e,t),this.quaternion.premultiply(oo),this}rotateX(e){return this.rotateOnAxis(Bg,e)}rotateY(e){return this.rotateOnAxis(kg,e)}rotateZ(e){return this.rotateOnAxis(Gg,e)}translateOnAxis(e,t){return Og.copy(e).applyQuaternion(this.quaternion),this.position.add(Og.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(Bg,e)}translateY(e){return this.translateOnAxis(kg,e)}translateZ(e){return this.translateOnAxis(Gg,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Ss.copy(this.matrixWorld).invert())}lookAt(e,t,i){e.isVector3?Kl.copy(e):Kl.set(e,t,i);let s=this.parent;this.updateWorldMatrix(!0,!1),ma.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Ss.lookAt(ma,Kl,this.up):Ss.lookAt(Kl,ma,this.up),this.quaternion.setFromRotationMatrix(Ss),s&&(Ss.extractRotation(s.matrixWorld),oo.setFromRotationMatrix(Ss),this.quaternion.premultiply(oo.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Qe("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(Vg),ao.child=e,this.dispatchEvent(ao),ao.child=null):Qe("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let i=0;i<arguments.length;i++)this.remove(arguments[i]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Db),vd.child=e,this.dispatchEvent(vd),vd.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Ss.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Ss.multiply(e.parent.matrixWorld)),e.applyMatrix4(Ss),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(Vg),ao.child=e,this.dispatchEvent(ao),ao.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let i=0,s=this.children.length;i<s;i++){let o=this.children[i].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,i=[]){this[e]===t&&i.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,i);return i}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(ma,e,Pb),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(ma,Lb,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,i=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*i-r[8]*s,r[13]+=i-r[1]*t-r[5]*i-r[9]*s,r[14]+=s-r[2]*t-r[6]*i-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].updateMatrixWorld(e)}updateWorldMatrix(e,t,i=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||i)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,i=!0),t===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,i)}}toJSON(e){let t=e===void 0||typeof e=="string",i={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},i.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(a=>({...a})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,c){return a[c.uuid]===void 0&&(a[c.uuid]=c.toJSON(e)),c.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let c=a.shapes;if(Array.isArray(c))for(let l=0,h=c.length;l<h;l++){let u=c[l];r(e.shapes,u)}else r(e.shapes,c)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let c=0,l=this.material.length;c<l;c++)a.push(r(e.materials,this.material[c]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let c=this.animations[a];s.animations.push(r(e.animations,c))}}if(t){let a=o(e.geometries),c=o(e.materials),l=o(e.textures),h=o(e.images),u=o(e.shapes),d=o(e.skeletons),f=o(e.animations),g=o(e.nodes);a.length>0&&(i.geometries=a),c.length>0&&(i.materials=c),l.length>0&&(i.textures=l),h.length>0&&(i.images=h),u.length>0&&(i.shapes=u),d.length>0&&(i.skeletons=d),f.length>0&&(i.animations=f),g.length>0&&(i.nodes=g)}return i.object=s,i;function o(a){let c=[];for(let l in a){let h=a[l];delete h.metadata,c.push(h)}return c}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let i=0;i<e.children.length;i++){let s=e.children[i];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};ei.DEFAULT_UP=new H(0,1,0);ei.DEFAULT_MATRIX_AUTO_UPDATE=!0;ei.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var ui=class extends ei{constructor(){super(),this.isGroup=!0,this.type="Group"}},Fb={type:"move"},Ao=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new ui,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new ui,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new H,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new H),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new ui,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new H,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new H,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let i of e.hand.values())this._getHandJoint(t,i)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,i){let s=null,r=null,o=null,a=this._targetRay,c=this._grip,l=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(l&&e.hand){o=!0;for(let v of e.hand.values()){let p=t.getJointPose(v,i),m=this._getHandJoint(l,v);p!==null&&(m.matrix.fromArray(p.transform.matrix),m.matrix.decompose(m.position,m.quaternion,m.scale),m.matrixWorldNeedsUpdate=!0,m.jointRadius=p.radius),m.visible=p!==null}let h=l.joints["index-finger-tip"],u=l.joints["thumb-tip"],d=h.position.distanceTo(u.position),f=.02,g=.005;l.inputState.pinching&&d>f+g?(l.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!l.inputState.pinching&&d<=f-g&&(l.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else c!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,i),r!==null&&(c.matrix.fromArray(r.transform.matrix),c.matrix.decompose(c.position,c.quaternion,c.scale),c.matrixWorldNeedsUpdate=!0,r.linearVelocity?(c.hasLinearVelocity=!0,c.linearVelocity.copy(r.linearVelocity)):c.hasLinearVelocity=!1,r.angularVelocity?(c.hasAngularVelocity=!0,c.angularVelocity.copy(r.angularVelocity)):c.hasAngularVelocity=!1,c.eventsEnabled&&c.dispatchEvent({type:"gripUpdated",data:e,target:this})));a!==null&&(s=t.getPose(e.targetRaySpace,i),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(Fb)))}return a!==null&&(a.visible=s!==null),c!==null&&(c.visible=r!==null),l!==null&&(l.visible=o!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let i=new ui;i.matrixAutoUpdate=!1,i.visible=!1,e.joints[t.jointName]=i,e.add(i)}return e.joints[t.jointName]}},W0={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},Ks={h:0,s:0,l:0},$l={h:0,s:0,l:0};function bd(n,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?n+(e-n)*6*t:t<1/2?e:t<2/3?n+(e-n)*6*(2/3-t):n}var _t=class{constructor(e,t,i){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,i)}set(e,t,i){if(t===void 0&&i===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,i);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=li){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,gt.colorSpaceToWorking(this,t),this}setRGB(e,t,i,s=gt.workingColorSpace){return this.r=e,this.g=t,this.b=i,gt.colorSpaceToWorking(this,s),this}setHSL(e,t,i,s=gt.workingColorSpace){if(e=yf(e,1),t=ft(t,0,1),i=ft(i,0,1),t===0)this.r=this.g=this.b=i;else{let r=i<=.5?i*(1+t):i+t-i*t,o=2*i-r;this.r=bd(o,r,e+1/3),this.g=bd(o,r,e),this.b=bd(o,r,e-1/3)}return gt.colorSpaceToWorking(this,s),this}setStyle(e,t=li){function i(r){r!==void 0&&parseFloat(r)<1&&Ze("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:Ze("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);Ze("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=li){let i=W0[e.toLowerCase()];return i!==void 0?this.setHex(i,t):Ze("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Rs(e.r),this.g=Rs(e.g),this.b=Rs(e.b),this}copyLinearToSRGB(e){return this.r=xo(e.r),this.g=xo(e.g),this.b=xo(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=li){return gt.workingToColorSpace(Gn.copy(this),e),Math.round(ft(Gn.r*255,0,255))*65536+Math.round(ft(Gn.g*255,0,255))*256+Math.round(ft(Gn.b*255,0,255))}getHexString(e=li){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=gt.workingColorSpace){gt.workingToColorSpace(Gn.copy(this),t);let i=Gn.r,s=Gn.g,r=Gn.b,o=Math.max(i,s,r),a=Math.min(i,s,r),c,l,h=(a+o)/2;if(a===o)c=0,l=0;else{let u=o-a;switch(l=h<=.5?u/(o+a):u/(2-o-a),o){case i:c=(s-r)/u+(s<r?6:0);break;case s:c=(r-i)/u+2;break;case r:c=(i-s)/u+4;break}c/=6}return e.h=c,e.s=l,e.l=h,e}getRGB(e,t=gt.workingColorSpace){return gt.workingToColorSpace(Gn.copy(this),t),e.r=Gn.r,e.g=Gn.g,e.b=Gn.b,e}getStyle(e=li){gt.workingToColorSpace(Gn.copy(this),e);let t=Gn.r,i=Gn.g,s=Gn.b;return e!==li?`color(${e} ${t.toFixed(3)} ${i.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(i*255)},${Math.round(s*255)})`}offsetHSL(e,t,i){return this.getHSL(Ks),this.setHSL(Ks.h+e,Ks.s+t,Ks.l+i)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,i){return this.r=e.r+(t.r-e.r)*i,this.g=e.g+(t.g-e.g)*i,this.b=e.b+(t.b-e.b)*i,this}lerpHSL(e,t){this.getHSL(Ks),e.getHSL($l);let i=ba(Ks.h,$l.h,t),s=ba(Ks.s,$l.s,t),r=ba(Ks.l,$l.l,t);return this.setHSL(i,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,i=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*i+r[6]*s,this.g=r[1]*t+r[4]*i+r[7]*s,this.b=r[2]*t+r[5]*i+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Gn=new _t;_t.NAMES=W0;var wa=class extends ei{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new js,this.environmentIntensity=1,this.environmentRotation=new js,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},ki=new H,Ms=new H,Sd=new H,Es=new H,lo=new H,co=new H,zg=new H,Md=new H,Ed=new H,Ad=new H,Td=new Jt,wd=new Jt,Rd=new Jt,ws=class n{constructor(e=new H,t=new H,i=new H){this.a=e,this.b=t,this.c=i}static getNormal(e,t,i,s){s.subVectors(i,t),ki.subVectors(e,t),s.cross(ki);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,i,s,r){ki.subVectors(s,t),Ms.subVectors(i,t),Sd.subVectors(e,t);let o=ki.dot(ki),a=ki.dot(Ms),c=ki.dot(Sd),l=Ms.dot(Ms),h=Ms.dot(Sd),u=o*l-a*a;if(u===0)return r.set(0,0,0),null;let d=1/u,f=(l*c-a*h)*d,g=(o*h-a*c)*d;return r.set(1-f-g,g,f)}static containsPoint(e,t,i,s){return this.getBarycoord(e,t,i,s,Es)===null?!1:Es.x>=0&&Es.y>=0&&Es.x+Es.y<=1}static getInterpolation(e,t,i,s,r,o,a,c){return this.getBarycoord(e,t,i,s,Es)===null?(c.x=0,c.y=0,"z"in c&&(c.z=0),"w"in c&&(c.w=0),null):(c.setScalar(0),c.addScaledVector(r,Es.x),c.addScaledVector(o,Es.y),c.addScaledVector(a,Es.z),c)}static getInterpolatedAttribute(e,t,i,s,r,o){return Td.setScalar(0),wd.setScalar(0),Rd.setScalar(0),Td.fromBufferAttribute(e,t),wd.fromBufferAttribute(e,i),Rd.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(Td,r.x),o.addScaledVector(wd,r.y),o.addScaledVector(Rd,r.z),o}static isFrontFacing(e,t,i,s){return ki.subVectors(i,t),Ms.subVectors(e,t),ki.cross(Ms).dot(s)<0}set(e,t,i){return this.a.copy(e),this.b.copy(t),this.c.copy(i),this}setFromPointsAndIndices(e,t,i,s){return this.a.copy(e[t]),this.b.copy(e[i]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,i,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,i),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return ki.subVectors(this.c,this.b),Ms.subVectors(this.a,this.b),ki.cross(Ms).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return n.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return n.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,i,s,r){return n.getInterpolation(e,this.a,this.b,this.c,t,i,s,r)}containsPoint(e){return n.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return n.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let i=this.a,s=this.b,r=this.c,o,a;lo.subVectors(s,i),co.subVectors(r,i),Md.subVectors(e,i);let c=lo.dot(Md),l=co.dot(Md);if(c<=0&&l<=0)return t.copy(i);Ed.subVectors(e,s);let h=lo.dot(Ed),u=co.dot(Ed);if(h>=0&&u<=h)return t.copy(s);let d=c*u-h*l;if(d<=0&&c>=0&&h<=0&&c-h>0)return o=c/(c-h),t.copy(i).addScaledVector(lo,o);Ad.subVectors(e,r);let f=lo.dot(Ad),g=co.dot(Ad);if(g>=0&&f<=g)return t.copy(r);let v=f*l-c*g;if(v<=0&&l>=0&&g<=0)return a=l/(l-g),t.copy(i).addScaledVector(co,a);let p=h*g-f*u;if(p<=0&&u-h>=0&&f-g>=0)return zg.subVectors(r,s),a=(u-h)/(u-h+(f-g)),t.copy(s).addScaledVector(zg,a);let m=1/(p+v+d);return o=v*m,a=d*m,t.copy(i).addScaledVector(lo,o).addScaledVector(co,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},Qs=class{constructor(e=new H(1/0,1/0,1/0),t=new H(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t+=3)this.expandByPoint(Gi.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,i=e.count;t<i;t++)this.expandByPoint(Gi.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let i=Gi.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(i),this.max.copy(e).add(i),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let i=e.geometry;if(i!==void 0){let r=i.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,Gi):Gi.fromBufferAttribute(r,o),Gi.applyMatrix4(e.matrixWorld),this.expandByPoint(Gi);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),ql.copy(e.boundingBox)):(i.boundingBox===null&&i.computeBoundingBox(),ql.copy(i.boundingBox)),ql.applyMatrix4(e.matrixWorld),this.union(ql)}let s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Gi),Gi.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,i;return e.normal.x>0?(t=e.normal.x*this.min.x,i=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,i=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,i+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,i+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,i+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,i+=e.normal.z*this.min.z),t<=-e.constant&&i>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(ga),Jl.subVectors(this.max,ga),uo.subVectors(e.a,ga),ho.subVectors(e.b,ga),fo.subVectors(e.c,ga),$s.subVectors(ho,uo),qs.subVectors(fo,ho),br.subVectors(uo,fo);let t=[0,-$s.z,$s.y,0,-qs.z,qs.y,0,-br.z,br.y,$s.z,0,-$s.x,qs.z,0,-qs.x,br.z,0,-br.x,-$s.y,$s.x,0,-qs.y,qs.x,0,-br.y,br.x,0];return!Cd(t,uo,ho,fo,Jl)||(t=[1,0,0,0,1,0,0,0,1],!Cd(t,uo,ho,fo,Jl))?!1:(jl.crossVectors($s,qs),t=[jl.x,jl.y,jl.z],Cd(t,uo,ho,fo,Jl))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Gi).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Gi).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(As[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),As[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),As[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),As[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),As[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),As[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),As[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),As[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(As),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},As=[new H,new H,new H,new H,new H,new H,new H,new H],Gi=new H,ql=new Qs,uo=new H,ho=new H,fo=new H,$s=new H,qs=new H,br=new H,ga=new H,Jl=new H,jl=new H,Sr=new H;function Cd(n,e,t,i,s){for(let r=0,o=n.length-3;r<=o;r+=3){Sr.fromArray(n,r);let a=s.x*Math.abs(Sr.x)+s.y*Math.abs(Sr.y)+s.z*Math.abs(Sr.z),c=e.dot(Sr),l=t.dot(Sr),h=i.dot(Sr);if(Math.max(-Math.max(c,l,h),Math.min(c,l,h))>a)return!1}return!0}var mn=new H,Ql=new $e,Ub=0,xn=class extends Vi{constructor(e,t,i=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Ub++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=i,this.usage=O0,this.updateRanges=[],this.gpuType=mi,this.version=0,this._normalizationScale=e!==void 0?vf(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,i){e*=this.itemSize,i*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[i+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,i=this.count;t<i;t++)Ql.fromBufferAttribute(this,t),Ql.applyMatrix3(e),this.setXY(t,Ql.x,Ql.y);else if(this.itemSize===3)for(let t=0,i=this.count;t<i;t++)mn.fromBufferAttribute(this,t),mn.applyMatrix3(e),this.setXYZ(t,mn.x,mn.y,mn.z);return this}applyMatrix4(e){for(let t=0,i=this.count;t<i;t++)mn.fromBufferAttribute(this,t),mn.applyMatrix4(e),this.setXYZ(t,mn.x,mn.y,mn.z);return this}applyNormalMatrix(e){for(let t=0,i=this.count;t<i;t++)mn.fromBufferAttribute(this,t),mn.applyNormalMatrix(e),this.setXYZ(t,mn.x,mn.y,mn.z);return this}transformDirection(e){for(let t=0,i=this.count;t<i;t++)mn.fromBufferAttribute(this,t),mn.transformDirection(e),this.setXYZ(t,mn.x,mn.y,mn.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let i=this.array[e*this.itemSize+t];return this.normalized&&(i=this._denormalize(i)),i}setComponent(e,t,i){return this.normalized&&(i=this._normalize(i)),this.array[e*this.itemSize+t]=i,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=i,this}setXYZ(e,t,i,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this}setXYZW(e,t,i,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):z0(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):H0(e,this.array)}};var Ra=class extends xn{constructor(e,t,i){super(new Uint16Array(e),t,i)}};var Ca=class extends xn{constructor(e,t,i){super(new Uint32Array(e),t,i)}};var vn=class extends xn{constructor(e,t,i){super(new Float32Array(e),t,i)}},Ob=new Qs,_a=new H,Id=new H,Is=class{constructor(e=new H,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let i=this.center;t!==void 0?i.copy(t):Ob.setFromPoints(e).getCenter(i);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,i.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let i=this.center.distanceToSquared(e);return t.copy(e),i>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;_a.subVectors(e,this.center);let t=_a.lengthSq();if(t>this.radius*this.radius){let i=Math.sqrt(t),s=(i-this.radius)*.5;this.center.addScaledVector(_a,s/i),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Id.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(_a.copy(e.center).add(Id)),this.expandByPoint(_a.copy(e.center).sub(Id))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},Bb=0,Ai=new Ft,Nd=new ei,po=new H,ai=new Qs,ya=new Qs,Nn=new H,Ln=class n extends Vi{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Bb++}),this.uuid=Lo(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(cb(e)?Ca:Ra)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,i=0){this.groups.push({start:e,count:t,materialIndex:i})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let i=this.attributes.normal;if(i!==void 0){let r=new tt().getNormalMatrix(e);i.applyNormalMatrix(r),i.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Ai.makeRotationFromQuaternion(e),this.applyMatrix4(Ai),this}rotateX(e){return Ai.makeRotationX(e),this.applyMatrix4(Ai),this}rotateY(e){return Ai.makeRotationY(e),this.applyMatrix4(Ai),this}rotateZ(e){return Ai.makeRotationZ(e),this.applyMatrix4(Ai),this}translate(e,t,i){return Ai.makeTranslation(e,t,i),this.applyMatrix4(Ai),this}scale(e,t,i){return Ai.makeScale(e,t,i),this.applyMatrix4(Ai),this}lookAt(e){return Nd.lookAt(e),Nd.updateMatrix(),this.applyMatrix4(Nd.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(po).negate(),this.translate(po.x,po.y,po.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let i=[];for(let s=0,r=e.length;s<r;s++){let o=e[s];i.push(o.x,o.y,o.z||0)}this.setAttribute("position",new vn(i,3))}else{let i=Math.min(e.length,t.count);for(let s=0;s<i;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&Ze("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Qs);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Qe("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new H(-1/0,-1/0,-1/0),new H(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let i=0,s=t.length;i<s;i++){let r=t[i];ai.setFromBufferAttribute(r),this.morphTargetsRelative?(Nn.addVectors(this.boundingBox.min,ai.min),this.boundingBox.expandByPoint(Nn),Nn.addVectors(this.boundingBox.max,ai.max),this.boundingBox.expandByPoint(Nn)):(this.boundingBox.expandByPoint(ai.min),this.boundingBox.expandByPoint(ai.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Qe('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Is);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Qe("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new H,1/0);return}if(e){let i=this.boundingSphere.center;if(ai.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){let a=t[r];ya.setFromBufferAttribute(a),this.morphTargetsRelative?(Nn.addVectors(ai.min,ya.min),ai.expandByPoint(Nn),Nn.addVectors(ai.max,ya.max),ai.expandByPoint(Nn)):(ai.expandByPoint(ya.min),ai.expandByPoint(ya.max))}ai.getCenter(i);let s=0;for(let r=0,o=e.count;r<o;r++)Nn.fromBufferAttribute(e,r),s=Math.max(s,i.distanceToSquared(Nn));if(t)for(let r=0,o=t.length;r<o;r++){let a=t[r],c=this.morphTargetsRelative;for(let l=0,h=a.count;l<h;l++)Nn.fromBufferAttribute(a,l),c&&(po.fromBufferAttribute(e,l),Nn.add(po)),s=Math.max(s,i.distanceToSquared(Nn))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Qe('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Qe("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let i=t.position,s=t.normal,r=t.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==i.count)&&(o=new xn(new Float32Array(4*i.count),4),this.setAttribute("tangent",o));let a=[],c=[],l=new Uint8Array(i.count);for(let B=0;B<i.count;B++)a[B]=new H,c[B]=new H;let h=new H,u=new H,d=new H,f=new $e,g=new $e,v=new $e,p=new H,m=new H;function b(B,D,L){l[B]=l[D]=l[L]=1,h.fromBufferAttribute(i,B),u.fromBufferAttribute(i,D),d.fromBufferAttribute(i,L),f.fromBufferAttribute(r,B),g.fromBufferAttribute(r,D),v.fromBufferAttribute(r,L),u.sub(h),d.sub(h),g.sub(f),v.sub(f);let k=1/(g.x*v.y-v.x*g.y);isFinite(k)&&(p.copy(u).multiplyScalar(v.y).addScaledVector(d,-g.y).multiplyScalar(k),m.copy(d).multiplyScalar(g.x).addScaledVector(u,-v.x).multiplyScalar(k),a[B].add(p),a[D].add(p),a[L].add(p),c[B].add(m),c[D].add(m),c[L].add(m))}let C=this.groups;C.length===0&&(C=[{start:0,count:e.count}]);for(let B=0,D=C.length;B<D;++B){let L=C[B],k=L.start,z=L.count;for(let P=k,W=k+z;P<W;P+=3)b(e.getX(P+0),e.getX(P+1),e.getX(P+2))}let E=new H,I=new H,T=new H,y=new H;function A(B){T.fromBufferAttribute(s,B),y.copy(T);let D=a[B];E.copy(D),E.sub(T.multiplyScalar(T.dot(D))).normalize(),I.crossVectors(y,D);let k=I.dot(c[B])<0?-1:1;o.setXYZW(B,E.x,E.y,E.z,k)}for(let B=0,D=i.count;B<D;++B)l[B]&&A(B);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let i=this.getAttribute("normal");if(i===void 0||i.count!==t.count)i=new xn(new Float32Array(t.count*3),3),this.setAttribute("normal",i);else for(let d=0,f=i.count;d<f;d++)i.setXYZ(d,0,0,0);let s=new H,r=new H,o=new H,a=new H,c=new H,l=new H,h=new H,u=new H;if(e)for(let d=0,f=e.count;d<f;d+=3){let g=e.getX(d+0),v=e.getX(d+1),p=e.getX(d+2);s.fromBufferAttribute(t,g),r.fromBufferAttribute(t,v),o.fromBufferAttribute(t,p),h.subVectors(o,r),u.subVectors(s,r),h.cross(u),a.fromBufferAttribute(i,g),c.fromBufferAttribute(i,v),l.fromBufferAttribute(i,p),a.add(h),c.add(h),l.add(h),i.setXYZ(g,a.x,a.y,a.z),i.setXYZ(v,c.x,c.y,c.z),i.setXYZ(p,l.x,l.y,l.z)}else for(let d=0,f=t.count;d<f;d+=3)s.fromBufferAttribute(t,d+0),r.fromBufferAttribute(t,d+1),o.fromBufferAttribute(t,d+2),h.subVectors(o,r),u.subVectors(s,r),h.cross(u),i.setXYZ(d+0,h.x,h.y,h.z),i.setXYZ(d+1,h.x,h.y,h.z),i.setXYZ(d+2,h.x,h.y,h.z);this.normalizeNormals(),i.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,i=e.count;t<i;t++)Nn.fromBufferAttribute(e,t),Nn.normalize(),e.setXYZ(t,Nn.x,Nn.y,Nn.z)}toNonIndexed(){function e(a,c){let l=a.array,h=a.itemSize,u=a.normalized,d=new l.constructor(c.length*h),f=0,g=0;for(let v=0,p=c.length;v<p;v++){a.isInterleavedBufferAttribute?f=c[v]*a.data.stride+a.offset:f=c[v]*h;for(let m=0;m<h;m++)d[g++]=l[f++]}return new xn(d,h,u)}if(this.index===null)return Ze("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new n,i=this.index.array,s=this.attributes;for(let a in s){let c=s[a],l=e(c,i);t.setAttribute(a,l)}let r=this.morphAttributes;for(let a in r){let c=[],l=r[a];for(let h=0,u=l.length;h<u;h++){let d=l[h],f=e(d,i);c.push(f)}t.morphAttributes[a]=c}t.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,c=o.length;a<c;a++){let l=o[a];t.addGroup(l.start,l.count,l.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let c=this.parameters;for(let l in c)c[l]!==void 0&&(e[l]=c[l]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let i=this.attributes;for(let c in i){let l=i[c];e.data.attributes[c]=l.toJSON(e.data)}let s={},r=!1;for(let c in this.morphAttributes){let l=this.morphAttributes[c],h=[];for(let u=0,d=l.length;u<d;u++){let f=l[u];h.push(f.toJSON(e.data))}h.length>0&&(s[c]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(e.data.boundingSphere=a.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let i=e.index;i!==null&&this.setIndex(i.clone());let s=e.attributes;for(let l in s){let h=s[l];this.setAttribute(l,h.clone(t))}let r=e.morphAttributes;for(let l in r){let h=[],u=r[l];for(let d=0,f=u.length;d<f;d++)h.push(u[d].clone(t));this.morphAttributes[l]=h}this.morphTargetsRelative=e.morphTargetsRelative;let o=e.groups;for(let l=0,h=o.length;l<h;l++){let u=o[l];this.addGroup(u.start,u.count,u.materialIndex)}let a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());let c=e.boundingSphere;return c!==null&&(this.boundingSphere=c.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var Pd=new H,kb=new H,Gb=new tt,ci=class{constructor(e=new H(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,i,s){return this.normal.set(e,t,i),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,i){let s=Pd.subVectors(i,t).cross(kb.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,i=!0){let s=e.delta(Pd),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let o=-(e.start.dot(this.normal)+this.constant)/r;return i===!0&&(o<0||o>1)?null:t.copy(e.start).addScaledVector(s,o)}intersectsLine(e){let t=this.distanceToPoint(e.start),i=this.distanceToPoint(e.end);return t<0&&i>0||i<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let i=t||Gb.getNormalMatrix(e),s=this.coplanarPoint(Pd).applyMatrix4(e),r=this.normal.applyMatrix3(i).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},Vb=0,er=class extends Vi{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Vb++}),this.uuid=Lo(),this.name="",this.type="Material",this.blending=Io,this.side=lr,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=$d,this.blendDst=qd,this.blendEquation=Ir,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new _t(0,0,0),this.blendAlpha=0,this.depthFunc=vo,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=N0,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=vc,this.stencilZFail=vc,this.stencilZPass=vc,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let i=e[t];if(i===void 0){Ze(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ze(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(i):s&&s.isVector2&&i&&i.isVector2||s&&s.isEuler&&i&&i.isEuler||s&&s.isVector3&&i&&i.isVector3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let i={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};i.uuid=this.uuid,i.type=this.type,i.blending=this.blending,i.side=this.side,i.shadowSide=this.shadowSide,i.vertexColors=this.vertexColors,i.opacity=this.opacity,i.transparent=this.transparent,i.blendSrc=this.blendSrc,i.blendDst=this.blendDst,i.blendEquation=this.blendEquation,i.blendSrcAlpha=this.blendSrcAlpha,i.blendDstAlpha=this.blendDstAlpha,i.blendEquationAlpha=this.blendEquationAlpha,i.blendColor=this.blendColor.getHex(),i.blendAlpha=this.blendAlpha,i.depthFunc=this.depthFunc,i.depthTest=this.depthTest,i.depthWrite=this.depthWrite,i.colorWrite=this.colorWrite,i.clipIntersection=this.clipIntersection,i.clipShadows=this.clipShadows,i.stencilWriteMask=this.stencilWriteMask,i.stencilFunc=this.stencilFunc,i.stencilRef=this.stencilRef,i.stencilFuncMask=this.stencilFuncMask,i.stencilFail=this.stencilFail,i.stencilZFail=this.stencilZFail,i.stencilZPass=this.stencilZPass,i.stencilWrite=this.stencilWrite,i.polygonOffset=this.polygonOffset,i.polygonOffsetFactor=this.polygonOffsetFactor,i.polygonOffsetUnits=this.polygonOffsetUnits,i.dithering=this.dithering,i.alphaTest=this.alphaTest,i.alphaHash=this.alphaHash,i.alphaToCoverage=this.alphaToCoverage,i.premultipliedAlpha=this.premultipliedAlpha,i.forceSinglePass=this.forceSinglePass,i.allowOverride=this.allowOverride,i.visible=this.visible,i.toneMapped=this.toneMapped,i.name=this.name,this.color&&this.color.isColor&&(i.color=this.color.getHex()),this.roughness!==void 0&&(i.roughness=this.roughness),this.metalness!==void 0&&(i.metalness=this.metalness),this.sheen!==void 0&&(i.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(i.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(i.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(i.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(i.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(i.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(i.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(i.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(i.shininess=this.shininess),this.clearcoat!==void 0&&(i.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(i.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(i.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(i.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(i.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(i.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(i.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,i.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(i.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(i.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(i.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(i.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(i.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(i.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(i.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(i.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(i.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(i.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(i.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(i.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(i.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(i.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(i.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(i.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(i.lightMap=this.lightMap.toJSON(e).uuid,i.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(i.aoMap=this.aoMap.toJSON(e).uuid,i.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(i.bumpMap=this.bumpMap.toJSON(e).uuid,i.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(i.normalMap=this.normalMap.toJSON(e).uuid,i.normalMapType=this.normalMapType,i.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(i.displacementMap=this.displacementMap.toJSON(e).uuid,i.displacementScale=this.displacementScale,i.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(i.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(i.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(i.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(i.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(i.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(i.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(i.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(i.combine=this.combine)),this.envMapRotation!==void 0&&(i.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(i.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(i.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(i.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(i.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(i.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(i.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(i.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(i.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(i.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(i.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(i.size=this.size),this.sizeAttenuation!==void 0&&(i.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(i.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(i.rotation=this.rotation),this.depthPacking!==void 0&&(i.depthPacking=this.depthPacking),this.linewidth!==void 0&&(i.linewidth=this.linewidth),this.linecap!==void 0&&(i.linecap=this.linecap),this.linejoin!==void 0&&(i.linejoin=this.linejoin),this.dashSize!==void 0&&(i.dashSize=this.dashSize),this.gapSize!==void 0&&(i.gapSize=this.gapSize),this.scale!==void 0&&(i.scale=this.scale),this.wireframe!==void 0&&(i.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(i.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(i.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(i.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(i.flatShading=this.flatShading),this.fog!==void 0&&(i.fog=this.fog),Object.keys(this.userData).length>0&&(i.userData=this.userData);function s(r){let o=[];for(let a in r){let c=r[a];delete c.metadata,o.push(c)}return o}if(t){let r=s(e.textures),o=s(e.images);r.length>0&&(i.textures=r),o.length>0&&(i.images=o)}return i}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new _t().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(i=>new ci().fromJSON(i))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let i=e.normalScale;Array.isArray(i)===!1&&(i=[i,i]),this.normalScale=new $e().fromArray(i)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new $e().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,i=null;if(t!==null){let s=t.length;i=new Array(s);for(let r=0;r!==s;++r)i[r]=t[r].clone()}return this.clippingPlanes=i,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var Ts=new H,Ld=new H,ec=new H,tc=new H,tr=class{constructor(e=new H,t=new H(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Ts)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let i=t.dot(this.direction);return i<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,i)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=Ts.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Ts.copy(this.origin).addScaledVector(this.direction,t),Ts.distanceToSquared(e))}distanceSqToSegment(e,t,i,s){Ld.copy(e).add(t).multiplyScalar(.5),ec.copy(t).sub(e).normalize(),tc.copy(this.origin).sub(Ld);let r=e.distanceTo(t)*.5,o=-this.direction.dot(ec),a=tc.dot(this.direction),c=-tc.dot(ec),l=tc.lengthSq(),h=Math.abs(1-o*o),u,d,f,g;if(h>0)if(u=o*c-a,d=o*a-c,g=r*h,u>=0)if(d>=-g)if(d<=g){let v=1/h;u*=v,d*=v,f=u*(u+o*d+2*a)+d*(o*u+d+2*c)+l}else d=r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*c)+l;else d=-r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*c)+l;else d<=-g?(u=Math.max(0,-(-o*r+a)),d=u>0?-r:Math.min(Math.max(-r,-c),r),f=-u*u+d*(d+2*c)+l):d<=g?(u=0,d=Math.min(Math.max(-r,-c),r),f=d*(d+2*c)+l):(u=Math.max(0,-(o*r+a)),d=u>0?r:Math.min(Math.max(-r,-c),r),f=-u*u+d*(d+2*c)+l);else d=o>0?-r:r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*c)+l;return i&&i.copy(this.origin).addScaledVector(this.direction,u),s&&s.copy(Ld).addScaledVector(ec,d),f}intersectSphere(e,t){if(e.radius<0)return null;Ts.subVectors(e.center,this.origin);let i=Ts.dot(this.direction),s=Ts.dot(Ts)-i*i,r=e.radius*e.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=i-o,c=i+o;return c<0?null:a<0?this.at(c,t):this.at(a,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let i=-(this.origin.dot(e.normal)+e.constant)/t;return i>=0?i:null}intersectPlane(e,t){let i=this.distanceToPlane(e);return i===null?null:this.at(i,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let i,s,r,o,a,c,l=1/this.direction.x,h=1/this.direction.y,u=1/this.direction.z,d=this.origin;return l>=0?(i=(e.min.x-d.x)*l,s=(e.max.x-d.x)*l):(i=(e.max.x-d.x)*l,s=(e.min.x-d.x)*l),h>=0?(r=(e.min.y-d.y)*h,o=(e.max.y-d.y)*h):(r=(e.max.y-d.y)*h,o=(e.min.y-d.y)*h),i>o||r>s||((r>i||isNaN(i))&&(i=r),(o<s||isNaN(s))&&(s=o),u>=0?(a=(e.min.z-d.z)*u,c=(e.max.z-d.z)*u):(a=(e.max.z-d.z)*u,c=(e.min.z-d.z)*u),i>c||a>s)||((a>i||i!==i)&&(i=a),(c<s||s!==s)&&(s=c),s<0)?null:this.at(i>=0?i:s,t)}intersectsBox(e){return this.intersectBox(e,Ts)!==null}intersectTriangle(e,t,i,s,r){let o=this.origin,a=this.direction,c=a.x,l=a.y,h=a.z,u=e.x-o.x,d=e.y-o.y,f=e.z-o.z,g=t.x-o.x,v=t.y-o.y,p=t.z-o.z,m=i.x-o.x,b=i.y-o.y,C=i.z-o.z,E=Math.abs(c),I=Math.abs(l),T=Math.abs(h),y,A,B,D,L,k,z,P,W,K,V,ue;if(E>=I&&E>=T?(B=c,k=u,W=g,ue=m,c>=0?(y=l,A=h,D=d,L=f,z=v,P=p,K=b,V=C):(y=h,A=l,D=f,L=d,z=p,P=v,K=C,V=b)):I>=T?(B=l,k=d,W=v,ue=b,l>=0?(y=h,A=c,D=f,L=u,z=p,P=g,K=C,V=m):(y=c,A=h,D=u,L=f,z=g,P=p,K=m,V=C)):(B=h,k=f,W=p,ue=C,h>=0?(y=c,A=l,D=u,L=d,z=g,P=v,K=m,V=b):(y=l,A=c,D=d,L=u,z=v,P=g,K=b,V=m)),B===0)return null;let j=y/B,ee=A/B,re=1/B,fe=D-j*k,de=L-ee*k,te=z-j*W,ge=P-ee*W,xe=K-j*ue,Re=V-ee*ue,Me=xe*ge-Re*te,We=fe*Re-de*xe,st=te*de-ge*fe;if(s){if(Me<0||We<0||st<0)return null}else if((Me<0||We<0||st<0)&&(Me>0||We>0||st>0))return null;let ze=Me+We+st;if(ze===0)return null;let ut=re*(Me*k+We*W+st*ue);return(ze>0?ut<0:ut>0)?null:this.at(ut/ze,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Ia=class extends er{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new _t(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new js,this.combine=Jd,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},Hg=new Ft,Mr=new tr,nc=new Is,Wg=new H,ic=new H,sc=new H,rc=new H,Dd=new H,oc=new H,Xg=new H,ac=new H,di=class extends ei{constructor(e=new Ln,t=new Ia){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){let i=this.geometry,s=i.attributes.position,r=i.morphAttributes.position,o=i.morphTargetsRelative;t.fromBufferAttribute(s,e);let a=this.morphTargetInfluences;if(r&&a){oc.set(0,0,0);for(let c=0,l=r.length;c<l;c++){let h=a[c],u=r[c];h!==0&&(Dd.fromBufferAttribute(u,e),o?oc.addScaledVector(Dd,h):oc.addScaledVector(Dd.sub(t),h))}t.add(oc)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(i.boundingSphere===null&&i.computeBoundingSphere(),nc.copy(i.boundingSphere),nc.applyMatrix4(r),Mr.copy(e.ray).recast(e.near),!(nc.containsPoint(Mr.origin)===!1&&(Mr.intersectSphere(nc,Wg)===null||Mr.origin.distanceToSquared(Wg)>(e.far-e.near)**2))&&(Hg.copy(r).invert(),Mr.copy(e.ray).applyMatrix4(Hg),!(i.boundingBox!==null&&Mr.intersectsBox(i.boundingBox)===!1)&&this._computeIntersections(e,t,Mr)))}_computeIntersections(e,t,i){let s,r=this.geometry,o=this.material,a=r.index,c=r.attributes.position,l=r.attributes.uv,h=r.attributes.uv1,u=r.attributes.normal,d=r.groups,f=r.drawRange;if(a!==null)if(Array.isArray(o))for(let g=0,v=d.length;g<v;g++){let p=d[g],m=o[p.materialIndex],b=Math.max(p.start,f.start),C=Math.min(a.count,Math.min(p.start+p.count,f.start+f.count));for(let E=b,I=C;E<I;E+=3){let T=a.getX(E),y=a.getX(E+1),A=a.getX(E+2);s=lc(this,m,e,i,l,h,u,T,y,A),s&&(s.faceIndex=Math.floor(E/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),v=Math.min(a.count,f.start+f.count);for(let p=g,m=v;p<m;p+=3){let b=a.getX(p),C=a.getX(p+1),E=a.getX(p+2);s=lc(this,o,e,i,l,h,u,b,C,E),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(c!==void 0)if(Array.isArray(o))for(let g=0,v=d.length;g<v;g++){let p=d[g],m=o[p.materialIndex],b=Math.max(p.start,f.start),C=Math.min(c.count,Math.min(p.start+p.count,f.start+f.count));for(let E=b,I=C;E<I;E+=3){let T=E,y=E+1,A=E+2;s=lc(this,m,e,i,l,h,u,T,y,A),s&&(s.faceIndex=Math.floor(E/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),v=Math.min(c.count,f.start+f.count);for(let p=g,m=v;p<m;p+=3){let b=p,C=p+1,E=p+2;s=lc(this,o,e,i,l,h,u,b,C,E),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}};function zb(n,e,t,i,s,r,o,a){let c;if(e.side===$n?c=i.intersectTriangle(o,r,s,!0,a):c=i.intersectTriangle(s,r,o,e.side===lr,a),c===null)return null;ac.copy(a),ac.applyMatrix4(n.matrixWorld);let l=t.ray.origin.distanceTo(ac);return l<t.near||l>t.far?null:{distance:l,point:ac.clone(),object:n}}function lc(n,e,t,i,s,r,o,a,c,l){n.getVertexPosition(a,ic),n.getVertexPosition(c,sc),n.getVertexPosition(l,rc);let h=zb(n,e,t,i,ic,sc,rc,Xg);if(h){let u=new H;ws.getBarycoord(Xg,ic,sc,rc,u),s&&(h.uv=ws.getInterpolatedAttribute(s,a,c,l,u,new $e)),r&&(h.uv1=ws.getInterpolatedAttribute(r,a,c,l,u,new $e)),o&&(h.normal=ws.getInterpolatedAttribute(o,a,c,l,u,new H),h.normal.dot(i.direction)>0&&h.normal.multiplyScalar(-1));let d={a,b:c,c:l,normal:new H,materialIndex:0};ws.getNormal(ic,sc,rc,d.normal),h.face=d,h.barycoord=u}return h}var Tr=class extends Qn{constructor(e=null,t=1,i=1,s,r,o,a,c,l=Pn,h=Pn,u,d){super(null,o,a,c,l,h,s,r,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:i},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Er=new Is,Hb=new $e(.5,.5),cc=new H,wr=class{constructor(e=new ci,t=new ci,i=new ci,s=new ci,r=new ci,o=new ci){this.planes=[e,t,i,s,r,o]}set(e,t,i,s,r,o){let a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(i),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){let t=this.planes;for(let i=0;i<6;i++)t[i].copy(e.planes[i]);return this}setFromProjectionMatrix(e,t=Ti,i=!1){let s=this.planes,r=e.elements,o=r[0],a=r[1],c=r[2],l=r[3],h=r[4],u=r[5],d=r[6],f=r[7],g=r[8],v=r[9],p=r[10],m=r[11],b=r[12],C=r[13],E=r[14],I=r[15];if(s[0].setComponents(l-o,f-h,m-g,I-b).normalize(),s[1].setComponents(l+o,f+h,m+g,I+b).normalize(),s[2].setComponents(l+a,f+u,m+v,I+C).normalize(),s[3].setComponents(l-a,f-u,m-v,I-C).normalize(),i)s[4].setComponents(c,d,p,E).normalize(),s[5].setComponents(l-c,f-d,m-p,I-E).normalize();else if(s[4].setComponents(l-c,f-d,m-p,I-E).normalize(),t===Ti)s[5].setComponents(l+c,f+d,m+p,I+E).normalize();else if(t===Ea)s[5].setComponents(c,d,p,E).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Er.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Er.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Er)}intersectsSprite(e){Er.center.set(0,0,0);let t=Hb.distanceTo(e.center);return Er.radius=.7071067811865476+t,Er.applyMatrix4(e.matrixWorld),this.intersectsSphere(Er)}intersectsSphere(e){let t=this.planes,i=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(i)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let i=0;i<6;i++){let s=t[i];if(cc.x=s.normal.x>0?e.max.x:e.min.x,cc.y=s.normal.y>0?e.max.y:e.min.y,cc.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(cc)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let i=0;i<6;i++)if(t[i].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Yg=new Ft,Dc=class n{constructor(){this.coordinateSystem=Ti,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,i=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];Yg.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),i[s]===void 0&&(i[s]=new wr),i[s].setFromProjectionMatrix(Yg,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,i=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new wr),t[s].copy(i[s]);return this._count=e._count,this}clone(){return new n().copy(this)}};var ss=class extends er{constructor(e){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new _t(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},Fc=new H,Uc=new H,Zg=new Ft,xa=new tr,uc=new Is,Fd=new H,Kg=new H,Rr=class extends ei{constructor(e=new Ln,t=new ss){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,i=[0];for(let s=1,r=t.count;s<r;s++)Fc.fromBufferAttribute(t,s-1),Uc.fromBufferAttribute(t,s),i[s]=i[s-1],i[s]+=Fc.distanceTo(Uc);e.setAttribute("lineDistance",new vn(i,1))}else Ze("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.matrixWorld,r=e.params.Line.threshold,o=i.drawRange;if(i.boundingSphere===null&&i.computeBoundingSphere(),uc.copy(i.boundingSphere),uc.applyMatrix4(s),uc.radius+=r,e.ray.intersectsSphere(uc)===!1)return;Zg.copy(s).invert(),xa.copy(e.ray).applyMatrix4(Zg);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),c=a*a,l=this.isLineSegments?2:1,h=i.index,d=i.attributes.position;if(h!==null){let f=Math.max(0,o.start),g=Math.min(h.count,o.start+o.count);for(let v=f,p=g-1;v<p;v+=l){let m=h.getX(v),b=h.getX(v+1),C=hc(this,e,xa,c,m,b,v);C&&t.push(C)}if(this.isLineLoop){let v=h.getX(g-1),p=h.getX(f),m=hc(this,e,xa,c,v,p,g-1);m&&t.push(m)}}else{let f=Math.max(0,o.start),g=Math.min(d.count,o.start+o.count);for(let v=f,p=g-1;v<p;v+=l){let m=hc(this,e,xa,c,v,v+1,v);m&&t.push(m)}if(this.isLineLoop){let v=hc(this,e,xa,c,g-1,f,g-1);v&&t.push(v)}}}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function hc(n,e,t,i,s,r,o){let a=n.geometry.attributes.position;if(Fc.fromBufferAttribute(a,s),Uc.fromBufferAttribute(a,r),t.distanceSqToSegment(Fc,Uc,Fd,Kg)>i)return;Fd.applyMatrix4(n.matrixWorld);let l=e.ray.origin.distanceTo(Fd);if(!(l<e.near||l>e.far))return{distance:l,point:Kg.clone().applyMatrix4(n.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:n}}var $g=new H,qg=new H,To=class extends Rr{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,i=[];for(let s=0,r=t.count;s<r;s+=2)$g.fromBufferAttribute(t,s),qg.fromBufferAttribute(t,s+1),i[s]=s===0?0:i[s-1],i[s+1]=i[s]+$g.distanceTo(qg);e.setAttribute("lineDistance",new vn(i,1))}else Ze("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var Na=class extends Qn{constructor(e=[],t=Nr,i,s,r,o,a,c,l,h){super(e,t,i,s,r,o,a,c,l,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Ns=class extends Qn{constructor(e,t,i=zi,s,r,o,a=Pn,c=Pn,l,h=Cs,u=1){if(h!==Cs&&h!==Ls)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let d={width:e,height:t,depth:u};super(d,s,r,o,a,c,h,i,l),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Mo(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},Pa=class extends Ns{constructor(e,t=zi,i=Nr,s,r,o=Pn,a=Pn,c,l=Cs){let h={width:e,height:e,depth:1},u=[h,h,h,h,h,h];super(e,e,t,i,s,r,o,a,c,l),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},La=class extends Qn{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},nr=class n extends Ln{constructor(e=1,t=1,i=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:i,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let c=[],l=[],h=[],u=[],d=0,f=0;g("z","y","x",-1,-1,i,t,e,o,r,0),g("z","y","x",1,-1,i,t,-e,o,r,1),g("x","z","y",1,1,e,i,t,s,o,2),g("x","z","y",1,-1,e,i,-t,s,o,3),g("x","y","z",1,-1,e,t,i,s,r,4),g("x","y","z",-1,-1,e,t,-i,s,r,5),this.setIndex(c),this.setAttribute("position",new vn(l,3)),this.setAttribute("normal",new vn(h,3)),this.setAttribute("uv",new vn(u,2));function g(v,p,m,b,C,E,I,T,y,A,B){let D=E/y,L=I/A,k=E/2,z=I/2,P=T/2,W=y+1,K=A+1,V=0,ue=0,j=new H;for(let ee=0;ee<K;ee++){let re=ee*L-z;for(let fe=0;fe<W;fe++){let de=fe*D-k;j[v]=de*b,j[p]=re*C,j[m]=P,l.push(j.x,j.y,j.z),j[v]=0,j[p]=0,j[m]=T>0?1:-1,h.push(j.x,j.y,j.z),u.push(fe/y),u.push(1-ee/A),V+=1}}for(let ee=0;ee<A;ee++)for(let re=0;re<y;re++){let fe=d+re+W*ee,de=d+re+W*(ee+1),te=d+(re+1)+W*(ee+1),ge=d+(re+1)+W*ee;c.push(fe,de,ge),c.push(de,te,ge),ue+=6}a.addGroup(f,ue,B),f+=ue,d+=V}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var Oc=class n extends Ln{constructor(e=1,t=1,i=1,s=32,r=1,o=!1,a=0,c=Math.PI*2){super(),this.type="CylinderGeometry",this.parameters={radiusTop:e,radiusBottom:t,height:i,radialSegments:s,heightSegments:r,openEnded:o,thetaStart:a,thetaLength:c};let l=this;s=Math.floor(s),r=Math.floor(r);let h=[],u=[],d=[],f=[],g=0,v=[],p=i/2,m=0;b(),o===!1&&(e>0&&C(!0),t>0&&C(!1)),this.setIndex(h),this.setAttribute("position",new vn(u,3)),this.setAttribute("normal",new vn(d,3)),this.setAttribute("uv",new vn(f,2));function b(){let E=new H,I=new H,T=0,y=(t-e)/i;for(let A=0;A<=r;A++){let B=[],D=A/r,L=D*(t-e)+e;for(let k=0;k<=s;k++){let z=k/s,P=z*c+a,W=Math.sin(P),K=Math.cos(P);I.x=L*W,I.y=-D*i+p,I.z=L*K,u.push(I.x,I.y,I.z),E.set(W,y,K).normalize(),d.push(E.x,E.y,E.z),f.push(z,1-D),B.push(g++)}v.push(B)}for(let A=0;A<s;A++)for(let B=0;B<r;B++){let D=v[B][A],L=v[B+1][A],k=v[B+1][A+1],z=v[B][A+1];(e>0||B!==0)&&(h.push(D,L,z),T+=3),(t>0||B!==r-1)&&(h.push(L,k,z),T+=3)}l.addGroup(m,T,0),m+=T}function C(E){let I=g,T=new $e,y=new H,A=0,B=E===!0?e:t,D=E===!0?1:-1;for(let k=1;k<=s;k++)u.push(0,p*D,0),d.push(0,D,0),f.push(.5,.5),g++;let L=g;for(let k=0;k<=s;k++){let P=k/s*c+a,W=Math.cos(P),K=Math.sin(P);y.x=B*K,y.y=p*D,y.z=B*W,u.push(y.x,y.y,y.z),d.push(0,D,0),T.x=W*.5+.5,T.y=K*.5*D+.5,f.push(T.x,T.y),g++}for(let k=0;k<s;k++){let z=I+k,P=L+k;E===!0?h.push(P,P+1,z):h.push(P+1,P,z),A+=3}l.addGroup(m,A,E===!0?1:2),m+=A}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.radiusTop,e.radiusBottom,e.height,e.radialSegments,e.heightSegments,e.openEnded,e.thetaStart,e.thetaLength)}},Bc=class n extends Oc{constructor(e=1,t=1,i=32,s=1,r=!1,o=0,a=Math.PI*2){super(0,e,t,i,s,r,o,a),this.type="ConeGeometry",this.parameters={radius:e,height:t,radialSegments:i,heightSegments:s,openEnded:r,thetaStart:o,thetaLength:a}}static fromJSON(e){return new n(e.radius,e.height,e.radialSegments,e.heightSegments,e.openEnded,e.thetaStart,e.thetaLength)}};var dc=new H,fc=new H,Ud=new H,pc=new ws,Da=class extends Ln{constructor(e=null,t=1){if(super(),this.type="EdgesGeometry",this.parameters={geometry:e,thresholdAngle:t},e!==null){let s=Math.pow(10,4),r=Math.cos(yo*t),o=e.getIndex(),a=e.getAttribute("position"),c=o?o.count:a.count,l=[0,0,0],h=["a","b","c"],u=new Array(3),d=new Map,f=[];for(let g=0;g<c;g+=3){o?(l[0]=o.getX(g),l[1]=o.getX(g+1),l[2]=o.getX(g+2)):(l[0]=g,l[1]=g+1,l[2]=g+2);let{a:v,b:p,c:m}=pc;if(v.fromBufferAttribute(a,l[0]),p.fromBufferAttribute(a,l[1]),m.fromBufferAttribute(a,l[2]),pc.getNormal(Ud),u[0]=`${Math.round(v.x*s)},${Math.round(v.y*s)},${Math.round(v.z*s)}`,u[1]=`${Math.round(p.x*s)},${Math.round(p.y*s)},${Math.round(p.z*s)}`,u[2]=`${Math.round(m.x*s)},${Math.round(m.y*s)},${Math.round(m.z*s)}`,!(u[0]===u[1]||u[1]===u[2]||u[2]===u[0]))for(let b=0;b<3;b++){let C=(b+1)%3,E=u[b],I=u[C],T=pc[h[b]],y=pc[h[C]],A=`${E}_${I}`,B=`${I}_${E}`,D=d.get(B);D?(Ud.dot(D.normal)<=r&&(f.push(T.x,T.y,T.z),f.push(y.x,y.y,y.z)),d.set(B,null)):d.has(A)||d.set(A,{index0:l[b],index1:l[C],normal:Ud.clone()})}}for(let g of d.values())if(g){let{index0:v,index1:p}=g;dc.fromBufferAttribute(a,v),fc.fromBufferAttribute(a,p),f.push(dc.x,dc.y,dc.z),f.push(fc.x,fc.y,fc.z)}this.setAttribute("position",new vn(f,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}};var Fa=class n extends Ln{constructor(e=1,t=1,i=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:i,heightSegments:s};let r=e/2,o=t/2,a=Math.floor(i),c=Math.floor(s),l=a+1,h=c+1,u=e/a,d=t/c,f=[],g=[],v=[],p=[];for(let m=0;m<h;m++){let b=m*d-o;for(let C=0;C<l;C++){let E=C*u-r;g.push(E,-b,0),v.push(0,0,1),p.push(C/a),p.push(1-m/c)}}for(let m=0;m<c;m++)for(let b=0;b<a;b++){let C=b+l*m,E=b+l*(m+1),I=b+1+l*(m+1),T=b+1+l*m;f.push(C,E,T),f.push(E,I,T)}this.setIndex(f),this.setAttribute("position",new vn(g,3)),this.setAttribute("normal",new vn(v,3)),this.setAttribute("uv",new vn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.widthSegments,e.heightSegments)}};function Lr(n){let e={};for(let t in n){e[t]={};for(let i in n[t]){let s=n[t][i];if(Jg(s))s.isRenderTargetTexture?(Ze("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][i]=null):e[t][i]=s.clone();else if(Array.isArray(s))if(Jg(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();e[t][i]=r}else e[t][i]=s.slice();else e[t][i]=s}}return e}function Vn(n){let e={};for(let t=0;t<n.length;t++){let i=Lr(n[t]);for(let s in i)e[s]=i[s]}return e}function Jg(n){return n&&(n.isColor||n.isMatrix3||n.isMatrix4||n.isVector2||n.isVector3||n.isVector4||n.isTexture||n.isQuaternion)}function Wb(n){let e=[];for(let t=0;t<n.length;t++)e.push(n[t].clone());return e}function Sf(n){let e=n.getRenderTarget();return e===null?n.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:gt.workingColorSpace}var X0={clone:Lr,merge:Vn},Xb=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Yb=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,wi=class extends er{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Xb,this.fragmentShader=Yb,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Lr(e.uniforms),this.uniformsGroups=Wb(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let i={};for(let s in this.extensions)this.extensions[s]===!0&&(i[s]=!0);return Object.keys(i).length>0&&(t.extensions=i),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let i in e.uniforms){let s=e.uniforms[i];switch(this.uniforms[i]={},s.type){case"t":this.uniforms[i].value=t[s.value]||null;break;case"c":this.uniforms[i].value=new _t().setHex(s.value);break;case"v2":this.uniforms[i].value=new $e().fromArray(s.value);break;case"v3":this.uniforms[i].value=new H().fromArray(s.value);break;case"v4":this.uniforms[i].value=new Jt().fromArray(s.value);break;case"m3":this.uniforms[i].value=new tt().fromArray(s.value);break;case"m4":this.uniforms[i].value=new Ft().fromArray(s.value);break;default:this.uniforms[i].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let i in e.extensions)this.extensions[i]=e.extensions[i];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},kc=class extends wi{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}};var Gc=class extends er{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=C0,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Vc=class extends er{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};var Ua=class extends ss{constructor(e){super(),this.isLineDashedMaterial=!0,this.type="LineDashedMaterial",this.scale=1,this.dashSize=3,this.gapSize=1,this.setValues(e)}copy(e){return super.copy(e),this.scale=e.scale,this.dashSize=e.dashSize,this.gapSize=e.gapSize,this}};function mo(n,e){return!n||n.constructor===e?n:typeof e.BYTES_PER_ELEMENT=="number"?new e(n):Array.prototype.slice.call(n)}function mc(n){return n!==void 0&&n.inTangents!==void 0&&n.outTangents!==void 0}var ir=class{constructor(e,t,i,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(i),this.sampleValues=t,this.valueSize=i,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,i=this._cachedIndex,s=t[i],r=t[i-1];n:{e:{let o;t:{i:if(!(e<s)){for(let a=i+2;;){if(s===void 0){if(e<r)break i;return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}if(i===a)break;if(r=s,s=t[++i],e<s)break e}o=t.length;break t}if(!(e>=r)){let a=t[1];e<a&&(i=2,r=a);for(let c=i-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(i===c)break;if(s=r,r=t[--i-1],e>=r)break e}o=i,i=0;break t}break n}for(;i<o;){let a=i+o>>>1;e<t[a]?o=a:i=a+1}if(s=t[i],r=t[i-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}this._cachedIndex=i,this.intervalChanged_(i,r,s)}return this.interpolate_(i,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,i=this.sampleValues,s=this.valueSize,r=e*s;for(let o=0;o!==s;++o)t[o]=i[r+o];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},zc=class extends ir{constructor(e,t,i,s){super(e,t,i,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:kd,endingEnd:kd}}intervalChanged_(e,t,i){let s=this.parameterPositions,r=e-2,o=e+1,a=s[r],c=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case Gd:r=e,a=2*t-i;break;case Vd:r=s.length-2,a=t+s[r]-s[r+1];break;default:r=e,a=i}if(c===void 0)switch(this.getSettings_().endingEnd){case Gd:o=e,c=2*i-t;break;case Vd:o=1,c=i+s[1]-s[0];break;default:o=e-1,c=t}let l=(i-t)*.5,h=this.valueSize;this._weightPrev=l/(t-a),this._weightNext=l/(c-i),this._offsetPrev=r*h,this._offsetNext=o*h}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,c=e*a,l=c-a,h=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,g=(i-t)/(s-t),v=g*g,p=v*g,m=-d*p+2*d*v-d*g,b=(1+d)*p+(-1.5-2*d)*v+(-.5+d)*g+1,C=(-1-f)*p+(1.5+f)*v+.5*g,E=f*p-f*v;for(let I=0;I!==a;++I)r[I]=m*o[h+I]+b*o[l+I]+C*o[c+I]+E*o[u+I];return r}},Hc=class extends ir{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,c=e*a,l=c-a,h=(i-t)/(s-t),u=1-h;for(let d=0;d!==a;++d)r[d]=o[l+d]*u+o[c+d]*h;return r}},Wc=class extends ir{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e){return this.copySampleValue_(e-1)}},Xc=class extends ir{interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,c=e*a,l=c-a,h=this.inTangents,u=this.outTangents;if(!h||!u){let g=(i-t)/(s-t),v=1-g;for(let p=0;p!==a;++p)r[p]=o[l+p]*v+o[c+p]*g;return r}let d=a*2,f=e-1;for(let g=0;g!==a;++g){let v=o[l+g],p=o[c+g],m=f*d+g*2,b=u[m],C=u[m+1],E=e*d+g*2,I=h[E],T=h[E+1],y=Kb(i,t,b,I,s);r[g]=Y0(y,v,C,T,p)}return r}};function Y0(n,e,t,i,s){let r=1-n;return r*r*r*e+3*r*r*n*t+3*r*n*n*i+n*n*n*s}function Zb(n,e,t,i,s){let r=1-n;return 3*r*r*(t-e)+6*r*n*(i-t)+3*n*n*(s-i)}function Kb(n,e,t,i,s){let r=(n-e)/(s-e);for(let o=0;o<8;o++){let a=Y0(r,e,t,i,s)-n;if(Math.abs(a)<1e-10)break;let c=Zb(r,e,t,i,s);if(Math.abs(c)<1e-10)break;r=Math.max(0,Math.min(1,r-a/c))}return r}var fi=class{constructor(e,t,i,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=mo(t,this.TimeBufferType),this.values=mo(i,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,i;if(t.toJSON!==this.toJSON)i=t.toJSON(e);else{i={name:e.name,times:mo(e.times,Array),values:mo(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(i.interpolation=s),mc(e.settings)&&(i.settings={inTangents:mo(e.settings.inTangents,Array),outTangents:mo(e.settings.outTangents,Array)})}return i.type=e.ValueTypeName,i}InterpolantFactoryMethodDiscrete(e){return new Wc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Hc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new zc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Xc(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case Sa:t=this.InterpolantFactoryMethodDiscrete;break;case Ic:t=this.InterpolantFactoryMethodLinear;break;case xc:t=this.InterpolantFactoryMethodSmooth;break;case Bd:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let i="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(i);return Ze("KeyframeTrack:",i),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Sa;case this.InterpolantFactoryMethodLinear:return Ic;case this.InterpolantFactoryMethodSmooth:return xc;case this.InterpolantFactoryMethodBezier:return Bd}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]+=e;mc(this.settings)&&(jg(this.settings.inTangents,e),jg(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]*=e;mc(this.settings)&&(Qg(this.settings.inTangents,e),Qg(this.settings.outTangents,e))}return this}trim(e,t){let i=this.times,s=i.length,r=0,o=s-1;for(;r!==s&&i[r]<e;)++r;for(;o!==-1&&i[o]>t;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=i.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Qe("KeyframeTrack: Invalid value size in track.",this),e=!1);let i=this.times,s=this.values,r=i.length;r===0&&(Qe("KeyframeTrack: Track is empty.",this),e=!1);let o=null;for(let a=0;a!==r;a++){let c=i[a];if(typeof c=="number"&&isNaN(c)){Qe("KeyframeTrack: Time is not a valid number.",this,a,c),e=!1;break}if(o!==null&&o>c){Qe("KeyframeTrack: Out of order keys.",this,a,c,o),e=!1;break}o=c}if(s!==void 0&&ub(s))for(let a=0,c=s.length;a!==c;++a){let l=s[a];if(isNaN(l)){Qe("KeyframeTrack: Value is not a valid number.",this,a,l),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),i=this.getValueSize(),s=this.getInterpolation()===xc,r=e.length-1,o=1;for(let a=1;a<r;++a){let c=!1,l=e[a],h=e[a+1];if(l!==h&&(a!==1||l!==e[0]))if(s)c=!0;else{let u=a*i,d=u-i,f=u+i;for(let g=0;g!==i;++g){let v=t[u+g];if(v!==t[d+g]||v!==t[f+g]){c=!0;break}}}if(c){if(a!==o){e[o]=e[a];let u=a*i,d=o*i;for(let f=0;f!==i;++f)t[d+f]=t[u+f]}++o}}if(r>0){e[o]=e[r];for(let a=r*i,c=o*i,l=0;l!==i;++l)t[c+l]=t[a+l];++o}return o!==e.length?(this.times=e.slice(0,o),this.values=t.slice(0,o*i)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),i=this.constructor,s=new i(this.name,e,t);return s.createInterpolant=this.createInterpolant,mc(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function jg(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]+=e}function Qg(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]*=e}fi.prototype.ValueTypeName="";fi.prototype.TimeBufferType=Float32Array;fi.prototype.ValueBufferType=Float32Array;fi.prototype.DefaultInterpolation=Ic;var sr=class extends fi{constructor(e,t,i){super(e,t,i)}};sr.prototype.ValueTypeName="bool";sr.prototype.ValueBufferType=Array;sr.prototype.DefaultInterpolation=Sa;sr.prototype.InterpolantFactoryMethodLinear=void 0;sr.prototype.InterpolantFactoryMethodSmooth=void 0;var Yc=class extends fi{constructor(e,t,i,s){super(e,t,i,s)}};Yc.prototype.ValueTypeName="color";var Zc=class extends fi{constructor(e,t,i,s){super(e,t,i,s)}};Zc.prototype.ValueTypeName="number";var Kc=class extends ir{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,c=(i-t)/(s-t),l=e*a;for(let h=l+a;l!==h;l+=4)Kn.slerpFlat(r,0,o,l-a,o,l,c);return r}},Oa=class extends fi{constructor(e,t,i,s){super(e,t,i,s)}InterpolantFactoryMethodLinear(e){return new Kc(this.times,this.values,this.getValueSize(),e)}};Oa.prototype.ValueTypeName="quaternion";Oa.prototype.InterpolantFactoryMethodSmooth=void 0;var rr=class extends fi{constructor(e,t,i){super(e,t,i)}};rr.prototype.ValueTypeName="string";rr.prototype.ValueBufferType=Array;rr.prototype.DefaultInterpolation=Sa;rr.prototype.InterpolantFactoryMethodLinear=void 0;rr.prototype.InterpolantFactoryMethodSmooth=void 0;var $c=class extends fi{constructor(e,t,i,s){super(e,t,i,s)}};$c.prototype.ValueTypeName="vector";var qc=class{constructor(e,t,i){let s=this,r=!1,o=0,a=0,c,l=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=i,this._abortController=null,this.itemStart=function(h){a++,r===!1&&s.onStart!==void 0&&s.onStart(h,o,a),r=!0},this.itemEnd=function(h){o++,s.onProgress!==void 0&&s.onProgress(h,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),c?c(h):h},this.setURLModifier=function(h){return c=h,this},this.addHandler=function(h,u){return l.push(h,u),this},this.removeHandler=function(h){let u=l.indexOf(h);return u!==-1&&l.splice(u,2),this},this.getHandler=function(h){for(let u=0,d=l.length;u<d;u+=2){let f=l[u],g=l[u+1];if(f.global&&(f.lastIndex=0),f.test(h))return g}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},Z0=new qc,Jc=class{constructor(e){this.manager=e!==void 0?e:Z0,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let i=this;return new Promise(function(s,r){i.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};Jc.DEFAULT_MATERIAL_NAME="__DEFAULT";var gc=new H,_c=new Kn,ns=new H,Ba=class extends ei{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Ft,this.projectionMatrix=new Ft,this.projectionMatrixInverse=new Ft,this.coordinateSystem=Ti,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(gc,_c,ns),ns.x===1&&ns.y===1&&ns.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(gc,_c,ns.set(1,1,1)).invert()}updateWorldMatrix(e,t,i=!1){super.updateWorldMatrix(e,t,i),this.matrixWorld.decompose(gc,_c,ns),ns.x===1&&ns.y===1&&ns.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(gc,_c,ns.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},Js=new H,e0=new $e,t0=new $e,Zn=class extends Ba{constructor(e=50,t=1,i=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=i,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=So*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(yo*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return So*2*Math.atan(Math.tan(yo*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,i){Js.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(Js.x,Js.y).multiplyScalar(-e/Js.z),Js.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),i.set(Js.x,Js.y).multiplyScalar(-e/Js.z)}getViewSize(e,t){return this.getViewBounds(e,e0,t0),t.subVectors(t0,e0)}setViewOffset(e,t,i,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(yo*.5*this.fov)/this.zoom,i=2*t,s=this.aspect*i,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let c=o.fullWidth,l=o.fullHeight;r+=o.offsetX*s/c,t-=o.offsetY*i/l,s*=o.width/c,i*=o.height/l}let a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-i,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var jc=class extends Ba{constructor(e=-1,t=1,i=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=i,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,i,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),i=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=i-e,o=i+e,a=s+t,c=s-t;if(this.view!==null&&this.view.enabled){let l=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=l*this.view.offsetX,o=r+l*this.view.width,a-=h*this.view.offsetY,c=a-h*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,c,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}};var go=-90,_o=1,wo=class extends ei{constructor(e,t,i){super(),this.type="CubeCamera",this.renderTarget=i,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new Zn(go,_o,e,t);s.layers=this.layers,this.add(s);let r=new Zn(go,_o,e,t);r.layers=this.layers,this.add(r);let o=new Zn(go,_o,e,t);o.layers=this.layers,this.add(o);let a=new Zn(go,_o,e,t);a.layers=this.layers,this.add(a);let c=new Zn(go,_o,e,t);c.layers=this.layers,this.add(c);let l=new Zn(go,_o,e,t);l.layers=this.layers,this.add(l)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[i,s,r,o,a,c]=t;for(let l of t)this.remove(l);if(e===Ti)i.up.set(0,1,0),i.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),c.up.set(0,1,0),c.lookAt(0,0,-1);else if(e===Ea)i.up.set(0,-1,0),i.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),c.up.set(0,-1,0),c.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let l of t)this.add(l),l.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:i,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,c,l,h]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),g=e.xr.enabled;e.xr.enabled=!1;let v=i.texture.mipmapsAutoUpdate;i.texture.mipmapsAutoUpdate=!1;let p=!1;e.isWebGLRenderer===!0?p=e.state.buffers.depth.getReversed():p=e.reversedDepthBuffer,e.setRenderTarget(i,0,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(i,1,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(i,2,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(i,3,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),e.setRenderTarget(i,4,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),i.texture.mipmapsAutoUpdate=v,e.setRenderTarget(i,5,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(u,d,f),e.xr.enabled=g,i.texture.needsPMREMUpdate=!0}},Qc=class extends Zn{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var Mf="\\[\\]\\.:\\/",$b=new RegExp("["+Mf+"]","g"),Ef="[^"+Mf+"]",qb="[^"+Mf.replace("\\.","")+"]",Jb=/((?:WC+[\/:])*)/.source.replace("WC",Ef),jb=/(WCOD+)?/.source.replace("WCOD",qb),Qb=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Ef),eS=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Ef),tS=new RegExp("^"+Jb+jb+Qb+eS+"$"),nS=["material","materials","bones","map"],zd=class{constructor(e,t,i){let s=i||Yt.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let i=this._targetGroup.nCachedObjects_,s=this._bindings[i];s!==void 0&&s.getValue(e,t)}setValue(e,t){let i=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=i.length;s!==r;++s)i[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].unbind()}},Yt=class n{constructor(e,t,i){this.path=t,this.parsedPath=i||n.parseTrackName(t),this.node=n.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,i){return e&&e.isAnimationObjectGroup?new n.Composite(e,t,i):new n(e,t,i)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace($b,"")}static parseTrackName(e){let t=tS.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let i={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=i.nodeName&&i.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=i.nodeName.substring(s+1);nS.indexOf(r)!==-1&&(i.nodeName=i.nodeName.substring(0,s),i.objectName=r)}if(i.propertyName===null||i.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return i}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let i=e.skeleton.getBoneByName(t);if(i!==void 0)return i}if(e.children){let i=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===t||a.uuid===t)return a;let c=i(a.children);if(c)return c}return null},s=i(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)e[t++]=i[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,i=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=n.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){Ze("PropertyBinding: No target node found for track: "+this.path+".");return}if(i){let l=t.objectIndex;switch(i){case"materials":if(!e.material){Qe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Qe("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Qe("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===l){l=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Qe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Qe("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[i]===void 0){Qe("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[i]}if(l!==void 0){if(e[l]===void 0){Qe("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[l]}}let o=e[s];if(o===void 0){let l=t.nodeName;Qe("PropertyBinding: Trying to update property for track: "+l+"."+s+" but it wasn't found.",e);return}let a=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?a=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Qe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Qe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};Yt.Composite=zd;Yt.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};Yt.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};Yt.prototype.GetterByBindingType=[Yt.prototype._getValue_direct,Yt.prototype._getValue_array,Yt.prototype._getValue_arrayElement,Yt.prototype._getValue_toArray];Yt.prototype.SetterByBindingTypeAndVersioning=[[Yt.prototype._setValue_direct,Yt.prototype._setValue_direct_setNeedsUpdate,Yt.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[Yt.prototype._setValue_array,Yt.prototype._setValue_array_setNeedsUpdate,Yt.prototype._setValue_array_setMatrixWorldNeedsUpdate],[Yt.prototype._setValue_arrayElement,Yt.prototype._setValue_arrayElement_setNeedsUpdate,Yt.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[Yt.prototype._setValue_fromArray,Yt.prototype._setValue_fromArray_setNeedsUpdate,Yt.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var JI=new Float32Array(1);var n0=new Ft,ka=class{constructor(e,t,i=0,s=1/0){this.ray=new tr(e,t),this.near=i,this.far=s,this.camera=null,this.layers=new Eo,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):Qe("Raycaster: Unsupported camera type: "+t.type)}setFromXRController(e){return n0.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(n0),this}intersectObject(e,t=!0,i=[]){return Hd(e,this,i,t),i.sort(i0),i}intersectObjects(e,t=!0,i=[]){for(let s=0,r=e.length;s<r;s++)Hd(e[s],this,i,t);return i.sort(i0),i}};function i0(n,e){return n.distance-e.distance}function Hd(n,e,t,i){let s=!0;if(n.layers.test(e.layers)&&n.raycast(e,t)===!1&&(s=!1),s===!0&&i===!0){let r=n.children;for(let o=0,a=r.length;o<a;o++)Hd(r[o],e,t,!0)}}var Ro=class{constructor(e=1,t=0,i=0){this.radius=e,this.phi=t,this.theta=i}set(e,t,i){return this.radius=e,this.phi=t,this.theta=i,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=ft(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,i){return this.radius=Math.sqrt(e*e+t*t+i*i),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,i),this.phi=Math.acos(ft(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var Wd=class{static{this.prototype.isMatrix2=!0}constructor(e,t,i,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,i,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let i=0;i<4;i++)this.elements[i]=e[i+t];return this}set(e,t,i,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=i,r[3]=s,this}};var s0=new H,yc,Od,Ga=class extends ei{constructor(e=new H(0,0,1),t=new H(0,0,0),i=1,s=16776960,r=i*.2,o=r*.2){super(),this.type="ArrowHelper",yc===void 0&&(yc=new Ln,yc.setAttribute("position",new vn([0,0,0,0,1,0],3)),Od=new Bc(.5,1,5,1),Od.translate(0,-.5,0)),this.position.copy(t),this.line=new Rr(yc,new ss({color:s,toneMapped:!1})),this.line.matrixAutoUpdate=!1,this.add(this.line),this.cone=new di(Od,new Ia({color:s,toneMapped:!1})),this.cone.matrixAutoUpdate=!1,this.add(this.cone),this.setDirection(e),this.setLength(i,r,o)}setDirection(e){if(e.y>.99999)this.quaternion.set(0,0,0,1);else if(e.y<-.99999)this.quaternion.set(1,0,0,0);else{s0.set(e.z,0,-e.x).normalize();let t=Math.acos(e.y);this.quaternion.setFromAxisAngle(s0,t)}}setLength(e,t=e*.2,i=t*.2){this.line.scale.set(1,Math.max(1e-4,e-t),1),this.line.updateMatrix(),this.cone.scale.set(i,t,i),this.cone.position.y=e,this.cone.updateMatrix()}setColor(e){this.line.material.color.set(e),this.cone.material.color.set(e)}copy(e){return super.copy(e,!1),this.line.copy(e.line),this.cone.copy(e.cone),this}dispose(){super.dispose(),this.line.geometry.dispose(),this.line.material.dispose(),this.cone.geometry.dispose(),this.cone.material.dispose()}};var Va=class extends Vi{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Af(n,e,t,i){let s=iS(i);switch(t){case hf:return n*e;case Wa:return n*e/s.components*s.byteLength;case ou:return n*e/s.components*s.byteLength;case cr:return n*e*2/s.components*s.byteLength;case au:return n*e*2/s.components*s.byteLength;case df:return n*e*3/s.components*s.byteLength;case Wi:return n*e*4/s.components*s.byteLength;case lu:return n*e*4/s.components*s.byteLength;case Xa:case Ya:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case Za:case Ka:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case uu:case du:return Math.max(n,16)*Math.max(e,8)/4;case cu:case hu:return Math.max(n,8)*Math.max(e,8)/2;case fu:case pu:case gu:case _u:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case mu:case $a:case yu:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case xu:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case vu:return Math.floor((n+4)/5)*Math.floor((e+3)/4)*16;case bu:return Math.floor((n+4)/5)*Math.floor((e+4)/5)*16;case Su:return Math.floor((n+5)/6)*Math.floor((e+4)/5)*16;case Mu:return Math.floor((n+5)/6)*Math.floor((e+5)/6)*16;case Eu:return Math.floor((n+7)/8)*Math.floor((e+4)/5)*16;case Au:return Math.floor((n+7)/8)*Math.floor((e+5)/6)*16;case Tu:return Math.floor((n+7)/8)*Math.floor((e+7)/8)*16;case wu:return Math.floor((n+9)/10)*Math.floor((e+4)/5)*16;case Ru:return Math.floor((n+9)/10)*Math.floor((e+5)/6)*16;case Cu:return Math.floor((n+9)/10)*Math.floor((e+7)/8)*16;case Iu:return Math.floor((n+9)/10)*Math.floor((e+9)/10)*16;case Nu:return Math.floor((n+11)/12)*Math.floor((e+9)/10)*16;case Pu:return Math.floor((n+11)/12)*Math.floor((e+11)/12)*16;case Lu:case Du:case Fu:return Math.ceil(n/4)*Math.ceil(e/4)*16;case Uu:case Ou:return Math.ceil(n/4)*Math.ceil(e/4)*8;case qa:case Bu:return Math.ceil(n/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function iS(n){switch(n){case pi:case af:return{byteLength:1,components:1};case Po:case lf:case Hi:return{byteLength:2,components:1};case su:case ru:return{byteLength:2,components:4};case zi:case iu:case mi:return{byteLength:4,components:1};case cf:case uf:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${n}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Ze("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function m_(){let n=null,e=!1,t=null,i=null;function s(r,o){i=n.requestAnimationFrame(s),t(r,o)}return{start:function(){e!==!0&&t!==null&&n!==null&&(i=n.requestAnimationFrame(s),e=!0)},stop:function(){n!==null&&n.cancelAnimationFrame(i),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){n=r}}}function rS(n){let e=new WeakMap;function t(a,c){let l=a.array,h=a.usage,u=l.byteLength,d=n.createBuffer();n.bindBuffer(c,d),n.bufferData(c,l,h),a.onUploadCallback();let f;if(l instanceof Float32Array)f=n.FLOAT;else if(typeof Float16Array<"u"&&l instanceof Float16Array)f=n.HALF_FLOAT;else if(l instanceof Uint16Array)a.isFloat16BufferAttribute?f=n.HALF_FLOAT:f=n.UNSIGNED_SHORT;else if(l instanceof Int16Array)f=n.SHORT;else if(l instanceof Uint32Array)f=n.UNSIGNED_INT;else if(l instanceof Int32Array)f=n.INT;else if(l instanceof Int8Array)f=n.BYTE;else if(l instanceof Uint8Array)f=n.UNSIGNED_BYTE;else if(l instanceof Uint8ClampedArray)f=n.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+l);return{buffer:d,type:f,bytesPerElement:l.BYTES_PER_ELEMENT,version:a.version,size:u}}function i(a,c,l){let h=c.array,u=c.updateRanges;if(n.bindBuffer(l,a),u.length===0)n.bufferSubData(l,0,h);else{u.sort((f,g)=>f.start-g.start);let d=0;for(let f=1;f<u.length;f++){let g=u[d],v=u[f];v.start<=g.start+g.count+1?g.count=Math.max(g.count,v.start+v.count-g.start):(++d,u[d]=v)}u.length=d+1;for(let f=0,g=u.length;f<g;f++){let v=u[f];n.bufferSubData(l,v.start*h.BYTES_PER_ELEMENT,h,v.start,v.count)}c.clearUpdateRanges()}c.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let c=e.get(a);c&&(n.deleteBuffer(c.buffer),e.delete(a))}function o(a,c){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let h=e.get(a);(!h||h.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let l=e.get(a);if(l===void 0)e.set(a,t(a,c));else if(l.version<a.version){if(l.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");i(l.buffer,a,c),l.version=a.version}}return{get:s,remove:r,update:o}}var oS=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,aS=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,lS=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,cS=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,uS=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,hS=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,dS=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,fS=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,pS=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,mS=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,gS=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,_S=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,yS=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,xS=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,vS=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,bS=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,SS=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,MS=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,ES=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,AS=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,TS=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,wS=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,RS=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,CS=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,IS=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,NS=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,PS=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,LS=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,DS=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,FS="gl_FragColor = linearToOutputTexel( gl_FragColor );",US=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,OS=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,BS=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,kS=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,GS=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,VS=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,zS=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,HS=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,WS=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,XS=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,YS=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,ZS=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,KS=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,$S=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,qS=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,JS=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,jS=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,QS=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,eM=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,tM=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,nM=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,iM=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,sM=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,rM=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,oM=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,aM=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,lM=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,cM=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,uM=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,hM=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,dM=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,fM=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,pM=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,mM=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,gM=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,_M=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,yM=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,xM=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,vM=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,bM=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,SM=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,MM=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,EM=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,AM=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,TM=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,wM=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,RM=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,CM=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,IM=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,NM=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,PM=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,LM=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,DM=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,FM=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,UM=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,OM=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,BM=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,kM=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,GM=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,VM=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,zM=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,HM=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,WM=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,XM=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,YM=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,ZM=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,KM=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,$M=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,qM=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,JM=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,jM=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,QM=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,eE=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,tE=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,nE=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,iE=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,sE=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,rE=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,oE=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,aE=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,lE=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cE=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,uE=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,hE=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,dE=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,fE=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,pE=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,mE=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,gE=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,_E=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,yE=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,xE=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,vE=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,bE=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,SE=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,ME=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,EE=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,AE=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,TE=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,wE=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,RE=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,CE=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,IE=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,NE=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,PE=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,LE=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,DE=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,FE=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,UE=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,OE=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,BE=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,ct={alphahash_fragment:oS,alphahash_pars_fragment:aS,alphamap_fragment:lS,alphamap_pars_fragment:cS,alphatest_fragment:uS,alphatest_pars_fragment:hS,aomap_fragment:dS,aomap_pars_fragment:fS,batching_pars_vertex:pS,batching_vertex:mS,begin_vertex:gS,beginnormal_vertex:_S,bsdfs:yS,iridescence_fragment:xS,bumpmap_pars_fragment:vS,clipping_planes_fragment:bS,clipping_planes_pars_fragment:SS,clipping_planes_pars_vertex:MS,clipping_planes_vertex:ES,color_fragment:AS,color_pars_fragment:TS,color_pars_vertex:wS,color_vertex:RS,common:CS,defaultnormal_vertex:IS,displacementmap_pars_vertex:NS,displacementmap_vertex:PS,emissivemap_fragment:LS,emissivemap_pars_fragment:DS,colorspace_fragment:FS,colorspace_pars_fragment:US,envmap_fragment:OS,envmap_common_pars_fragment:BS,envmap_pars_fragment:kS,envmap_pars_vertex:GS,envmap_physical_pars_fragment:JS,envmap_vertex:VS,fog_vertex:zS,fog_pars_vertex:HS,fog_fragment:WS,fog_pars_fragment:XS,gradientmap_pars_fragment:YS,lightmap_pars_fragment:ZS,lights_lambert_fragment:KS,lights_lambert_pars_fragment:$S,lights_pars_begin:qS,lights_toon_fragment:jS,lights_toon_pars_fragment:QS,lights_phong_fragment:eM,lights_phong_pars_fragment:tM,lights_physical_fragment:nM,lights_physical_pars_fragment:iM,lights_fragment_begin:sM,lights_fragment_maps:rM,lights_fragment_end:oM,lightprobes_pars_fragment:aM,logdepthbuf_fragment:lM,logdepthbuf_pars_fragment:cM,logdepthbuf_pars_vertex:uM,logdepthbuf_vertex:hM,map_fragment:dM,map_pars_fragment:fM,map_particle_fragment:pM,map_particle_pars_fragment:mM,metalnessmap_fragment:gM,metalnessmap_pars_fragment:_M,morphinstance_vertex:yM,morphcolor_vertex:xM,morphnormal_vertex:vM,morphtarget_pars_vertex:bM,morphtarget_vertex:SM,normal_fragment_begin:MM,normal_fragment_maps:EM,normal_pars_fragment:AM,normal_pars_vertex:TM,normal_vertex:wM,normalmap_pars_fragment:RM,clearcoat_normal_fragment_begin:CM,clearcoat_normal_fragment_maps:IM,clearcoat_pars_fragment:NM,iridescence_pars_fragment:PM,opaque_fragment:LM,packing:DM,premultiplied_alpha_fragment:FM,project_vertex:UM,dithering_fragment:OM,dithering_pars_fragment:BM,roughnessmap_fragment:kM,roughnessmap_pars_fragment:GM,shadowmap_pars_fragment:VM,shadowmap_pars_vertex:zM,shadowmap_vertex:HM,shadowmask_pars_fragment:WM,skinbase_vertex:XM,skinning_pars_vertex:YM,skinning_vertex:ZM,skinnormal_vertex:KM,specularmap_fragment:$M,specularmap_pars_fragment:qM,tonemapping_fragment:JM,tonemapping_pars_fragment:jM,transmission_fragment:QM,transmission_pars_fragment:eE,uv_pars_fragment:tE,uv_pars_vertex:nE,uv_vertex:iE,worldpos_vertex:sE,background_vert:rE,background_frag:oE,backgroundCube_vert:aE,backgroundCube_frag:lE,cube_vert:cE,cube_frag:uE,depth_vert:hE,depth_frag:dE,distance_vert:fE,distance_frag:pE,equirect_vert:mE,equirect_frag:gE,linedashed_vert:_E,linedashed_frag:yE,meshbasic_vert:xE,meshbasic_frag:vE,meshlambert_vert:bE,meshlambert_frag:SE,meshmatcap_vert:ME,meshmatcap_frag:EE,meshnormal_vert:AE,meshnormal_frag:TE,meshphong_vert:wE,meshphong_frag:RE,meshphysical_vert:CE,meshphysical_frag:IE,meshtoon_vert:NE,meshtoon_frag:PE,points_vert:LE,points_frag:DE,shadow_vert:FE,shadow_frag:UE,sprite_vert:OE,sprite_frag:BE},Le={common:{diffuse:{value:new _t(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new tt},alphaMap:{value:null},alphaMapTransform:{value:new tt},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new tt}},envmap:{envMap:{value:null},envMapRotation:{value:new tt},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new tt}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new tt}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new tt},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new tt},normalScale:{value:new $e(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new tt},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new tt}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new tt}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new tt}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new _t(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new _t(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new tt},alphaTest:{value:0},uvTransform:{value:new tt}},sprite:{diffuse:{value:new _t(16777215)},opacity:{value:1},center:{value:new $e(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new tt},alphaMap:{value:null},alphaMapTransform:{value:new tt},alphaTest:{value:0}}},as={basic:{uniforms:Vn([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.fog]),vertexShader:ct.meshbasic_vert,fragmentShader:ct.meshbasic_frag},lambert:{uniforms:Vn([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,Le.lights,{emissive:{value:new _t(0)},envMapIntensity:{value:1}}]),vertexShader:ct.meshlambert_vert,fragmentShader:ct.meshlambert_frag},phong:{uniforms:Vn([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,Le.lights,{emissive:{value:new _t(0)},specular:{value:new _t(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:ct.meshphong_vert,fragmentShader:ct.meshphong_frag},standard:{uniforms:Vn([Le.common,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.roughnessmap,Le.metalnessmap,Le.fog,Le.lights,{emissive:{value:new _t(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:ct.meshphysical_vert,fragmentShader:ct.meshphysical_frag},toon:{uniforms:Vn([Le.common,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.gradientmap,Le.fog,Le.lights,{emissive:{value:new _t(0)}}]),vertexShader:ct.meshtoon_vert,fragmentShader:ct.meshtoon_frag},matcap:{uniforms:Vn([Le.common,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,{matcap:{value:null}}]),vertexShader:ct.meshmatcap_vert,fragmentShader:ct.meshmatcap_frag},points:{uniforms:Vn([Le.points,Le.fog]),vertexShader:ct.points_vert,fragmentShader:ct.points_frag},dashed:{uniforms:Vn([Le.common,Le.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:ct.linedashed_vert,fragmentShader:ct.linedashed_frag},depth:{uniforms:Vn([Le.common,Le.displacementmap]),vertexShader:ct.depth_vert,fragmentShader:ct.depth_frag},normal:{uniforms:Vn([Le.common,Le.bumpmap,Le.normalmap,Le.displacementmap,{opacity:{value:1}}]),vertexShader:ct.meshnormal_vert,fragmentShader:ct.meshnormal_frag},sprite:{uniforms:Vn([Le.sprite,Le.fog]),vertexShader:ct.sprite_vert,fragmentShader:ct.sprite_frag},background:{uniforms:{uvTransform:{value:new tt},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:ct.background_vert,fragmentShader:ct.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new tt}},vertexShader:ct.backgroundCube_vert,fragmentShader:ct.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:ct.cube_vert,fragmentShader:ct.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:ct.equirect_vert,fragmentShader:ct.equirect_frag},distance:{uniforms:Vn([Le.common,Le.displacementmap,{referencePosition:{value:new H},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:ct.distance_vert,fragmentShader:ct.distance_frag},shadow:{uniforms:Vn([Le.lights,Le.fog,{color:{value:new _t(0)},opacity:{value:1}}]),vertexShader:ct.shadow_vert,fragmentShader:ct.shadow_frag}};as.physical={uniforms:Vn([as.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new tt},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new tt},clearcoatNormalScale:{value:new $e(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new tt},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new tt},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new tt},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new tt},sheen:{value:0},sheenColor:{value:new _t(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new tt},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new tt},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new tt},transmissionSamplerSize:{value:new $e},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new tt},attenuationDistance:{value:0},attenuationColor:{value:new _t(0)},specularColor:{value:new _t(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new tt},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new tt},anisotropyVector:{value:new $e},anisotropyMap:{value:null},anisotropyMapTransform:{value:new tt}}]),vertexShader:ct.meshphysical_vert,fragmentShader:ct.meshphysical_frag};var ku={r:0,b:0,g:0},kE=new Ft,g_=new tt;g_.set(-1,0,0,0,1,0,0,0,1);function GE(n,e,t,i,s,r){let o=new _t(0),a=s===!0?0:1,c,l,h=null,u=0,d=null;function f(b){let C=b.isScene===!0?b.background:null;if(C&&C.isTexture){let E=b.backgroundBlurriness>0;C=e.get(C,E)}return C}function g(b){let C=!1,E=f(b);E===null?p(o,a):E&&E.isColor&&(p(E,1),C=!0);let I=n.xr.getEnvironmentBlendMode();I==="additive"?t.buffers.color.setClear(0,0,0,1,r):I==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(n.autoClear||C)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),n.clear(n.autoClearColor,n.autoClearDepth,n.autoClearStencil))}function v(b,C){let E=f(C);E&&E.isCubeTexture?(l===void 0&&(l=new di(new nr(1,1,1),new wi({name:"BackgroundCubeMaterial",uniforms:Lr(as.backgroundCube.uniforms),vertexShader:as.backgroundCube.vertexShader,fragmentShader:as.backgroundCube.fragmentShader,side:$n,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),l.geometry.deleteAttribute("uv"),l.onBeforeRender=function(I,T,y){this.matrixWorld.copyPosition(y.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),i.update(l)),l.material.uniforms.envMap.value=E,l.material.uniforms.backgroundBlurriness.value=C.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(kE.makeRotationFromEuler(C.backgroundRotation)).transpose(),E.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(g_),l.material.toneMapped=gt.getTransfer(E.colorSpace)!==wt,(h!==E||u!==E.version||d!==n.toneMapping)&&(l.material.needsUpdate=!0,h=E,u=E.version,d=n.toneMapping),l.layers.enableAll(),b.unshift(l,l.geometry,l.material,0,0,null)):E&&E.isTexture&&(c===void 0&&(c=new di(new Fa(2,2),new wi({name:"BackgroundMaterial",uniforms:Lr(as.background.uniforms),vertexShader:as.background.vertexShader,fragmentShader:as.background.fragmentShader,side:lr,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),i.update(c)),c.material.uniforms.t2D.value=E,c.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,c.material.toneMapped=gt.getTransfer(E.colorSpace)!==wt,E.matrixAutoUpdate===!0&&E.updateMatrix(),c.material.uniforms.uvTransform.value.copy(E.matrix),(h!==E||u!==E.version||d!==n.toneMapping)&&(c.material.needsUpdate=!0,h=E,u=E.version,d=n.toneMapping),c.layers.enableAll(),b.unshift(c,c.geometry,c.material,0,0,null))}function p(b,C){b.getRGB(ku,Sf(n)),t.buffers.color.setClear(ku.r,ku.g,ku.b,C,r)}function m(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(b,C=1){o.set(b),a=C,p(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(b){a=b,p(o,a)},render:g,addToRenderList:v,dispose:m}}function VE(n,e){let t=n.getParameter(n.MAX_VERTEX_ATTRIBS),i={},s=d(null),r=s,o=!1;function a(L,k,z,P,W){let K=!1,V=u(L,P,z,k);r!==V&&(r=V,l(r.object)),K=f(L,P,z,W),K&&g(L,P,z,W),W!==null&&e.update(W,n.ELEMENT_ARRAY_BUFFER),(K||o)&&(o=!1,E(L,k,z,P),W!==null&&n.bindBuffer(n.ELEMENT_ARRAY_BUFFER,e.get(W).buffer))}function c(){return n.createVertexArray()}function l(L){return n.bindVertexArray(L)}function h(L){return n.deleteVertexArray(L)}function u(L,k,z,P){let W=P.wireframe===!0,K=i[k.id];K===void 0&&(K={},i[k.id]=K);let V=L.isInstancedMesh===!0?L.id:0,ue=K[V];ue===void 0&&(ue={},K[V]=ue);let j=ue[z.id];j===void 0&&(j={},ue[z.id]=j);let ee=j[W];return ee===void 0&&(ee=d(c()),j[W]=ee),ee}function d(L){let k=[],z=[],P=[];for(let W=0;W<t;W++)k[W]=0,z[W]=0,P[W]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:k,enabledAttributes:z,attributeDivisors:P,object:L,attributes:{},index:null}}function f(L,k,z,P){let W=r.attributes,K=k.attributes,V=0,ue=z.getAttributes();for(let j in ue)if(ue[j].location>=0){let re=W[j],fe=K[j];if(fe===void 0&&(j==="instanceMatrix"&&L.instanceMatrix&&(fe=L.instanceMatrix),j==="instanceColor"&&L.instanceColor&&(fe=L.instanceColor)),re===void 0||re.attribute!==fe||fe&&re.data!==fe.data)return!0;V++}return r.attributesNum!==V||r.index!==P}function g(L,k,z,P){let W={},K=k.attributes,V=0,ue=z.getAttributes();for(let j in ue)if(ue[j].location>=0){let re=K[j];re===void 0&&(j==="instanceMatrix"&&L.instanceMatrix&&(re=L.instanceMatrix),j==="instanceColor"&&L.instanceColor&&(re=L.instanceColor));let fe={};fe.attribute=re,re&&re.data&&(fe.data=re.data),W[j]=fe,V++}r.attributes=W,r.attributesNum=V,r.index=P}function v(){let L=r.newAttributes;for(let k=0,z=L.length;k<z;k++)L[k]=0}function p(L){m(L,0)}function m(L,k){let z=r.newAttributes,P=r.enabledAttributes,W=r.attributeDivisors;z[L]=1,P[L]===0&&(n.enableVertexAttribArray(L),P[L]=1),W[L]!==k&&(n.vertexAttribDivisor(L,k),W[L]=k)}function b(){let L=r.newAttributes,k=r.enabledAttributes;for(let z=0,P=k.length;z<P;z++)k[z]!==L[z]&&(n.disableVertexAttribArray(z),k[z]=0)}function C(L,k,z,P,W,K,V){V===!0?n.vertexAttribIPointer(L,k,z,W,K):n.vertexAttribPointer(L,k,z,P,W,K)}function E(L,k,z,P){v();let W=P.attributes,K=z.getAttributes(),V=k.defaultAttributeValues;for(let ue in K){let j=K[ue];if(j.location>=0){let ee=W[ue];if(ee===void 0&&(ue==="instanceMatrix"&&L.instanceMatrix&&(ee=L.instanceMatrix),ue==="instanceColor"&&L.instanceColor&&(ee=L.instanceColor)),ee!==void 0){let re=ee.normalized,fe=ee.itemSize,de=e.get(ee);if(de===void 0)continue;let te=de.buffer,ge=de.type,xe=de.bytesPerElement,Re=ge===n.INT||ge===n.UNSIGNED_INT||ee.gpuType===iu;if(ee.isInterleavedBufferAttribute){let Me=ee.data,We=Me.isInterleavedBuffer===!0?Me.stride:Me.itemSize,st=ee.offset;if(Me.isInstancedInterleavedBuffer||Me.isInstancedBufferAttribute){for(let ze=0;ze<j.locationSize;ze++)m(j.location+ze,Me.meshPerAttribute);L.isInstancedMesh!==!0&&P._maxInstanceCount===void 0&&(P._maxInstanceCount=Me.meshPerAttribute*Me.count)}else for(let ze=0;ze<j.locationSize;ze++)p(j.location+ze);n.bindBuffer(n.ARRAY_BUFFER,te);for(let ze=0;ze<j.locationSize;ze++)C(j.location+ze,fe/j.locationSize,ge,re,We*xe,(st+fe/j.locationSize*ze)*xe,Re)}else{if(ee.isInstancedBufferAttribute){for(let Me=0;Me<j.locationSize;Me++)m(j.location+Me,ee.meshPerAttribute);L.isInstancedMesh!==!0&&P._maxInstanceCount===void 0&&(P._maxInstanceCount=ee.meshPerAttribute*ee.count)}else for(let Me=0;Me<j.locationSize;Me++)p(j.location+Me);n.bindBuffer(n.ARRAY_BUFFER,te);for(let Me=0;Me<j.locationSize;Me++)C(j.location+Me,fe/j.locationSize,ge,re,fe*xe,fe/j.locationSize*Me*xe,Re)}}else if(V!==void 0){let re=V[ue];if(re!==void 0)switch(re.length){case 2:n.vertexAttrib2fv(j.location,re);break;case 3:n.vertexAttrib3fv(j.location,re);break;case 4:n.vertexAttrib4fv(j.location,re);break;default:n.vertexAttrib1fv(j.location,re)}}}}b()}function I(){B();for(let L in i){let k=i[L];for(let z in k){let P=k[z];for(let W in P){let K=P[W];for(let V in K)h(K[V].object),delete K[V];delete P[W]}}delete i[L]}}function T(L){if(i[L.id]===void 0)return;let k=i[L.id];for(let z in k){let P=k[z];for(let W in P){let K=P[W];for(let V in K)h(K[V].object),delete K[V];delete P[W]}}delete i[L.id]}function y(L){for(let k in i){let z=i[k];for(let P in z){let W=z[P];if(W[L.id]===void 0)continue;let K=W[L.id];for(let V in K)h(K[V].object),delete K[V];delete W[L.id]}}}function A(L){for(let k in i){let z=i[k],P=L.isInstancedMesh===!0?L.id:0,W=z[P];if(W!==void 0){for(let K in W){let V=W[K];for(let ue in V)h(V[ue].object),delete V[ue];delete W[K]}delete z[P],Object.keys(z).length===0&&delete i[k]}}}function B(){D(),o=!0,r!==s&&(r=s,l(r.object))}function D(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:B,resetDefaultState:D,dispose:I,releaseStatesOfGeometry:T,releaseStatesOfObject:A,releaseStatesOfProgram:y,initAttributes:v,enableAttribute:p,disableUnusedAttributes:b}}function zE(n,e,t){let i;function s(c){i=c}function r(c,l){n.drawArrays(i,c,l),t.update(l,i,1)}function o(c,l,h){h!==0&&(n.drawArraysInstanced(i,c,l,h),t.update(l,i,h))}function a(c,l,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(i,c,0,l,0,h);let d=0;for(let f=0;f<h;f++)d+=l[f];t.update(d,i,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function HE(n,e,t,i){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let y=e.get("EXT_texture_filter_anisotropic");s=n.getParameter(y.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(y){return!(y!==Wi&&i.convert(y)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(y){let A=y===Hi&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(y!==pi&&y!==mi&&!A&&i.convert(y)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_TYPE))}function c(y){if(y==="highp"){if(n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.HIGH_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.HIGH_FLOAT).precision>0)return"highp";y="mediump"}return y==="mediump"&&n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.MEDIUM_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let l=t.precision!==void 0?t.precision:"highp",h=c(l);h!==l&&(Ze("WebGLRenderer:",l,"not supported, using",h,"instead."),l=h);let u=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),d=t.logarithmicDepthBuffer===!0&&u===!1;t.reversedDepthBuffer===!0&&u===!1&&Ze("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&u===!0&&Ze("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=n.getParameter(n.MAX_TEXTURE_IMAGE_UNITS),g=n.getParameter(n.MAX_VERTEX_TEXTURE_IMAGE_UNITS),v=n.getParameter(n.MAX_TEXTURE_SIZE),p=n.getParameter(n.MAX_CUBE_MAP_TEXTURE_SIZE),m=n.getParameter(n.MAX_VERTEX_ATTRIBS),b=n.getParameter(n.MAX_VERTEX_UNIFORM_VECTORS),C=n.getParameter(n.MAX_VARYING_VECTORS),E=n.getParameter(n.MAX_FRAGMENT_UNIFORM_VECTORS),I=n.getParameter(n.MAX_SAMPLES),T=n.getParameter(n.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:a,precision:l,logarithmicDepthBuffer:d,reversedDepthBuffer:u,maxTextures:f,maxVertexTextures:g,maxTextureSize:v,maxCubemapSize:p,maxAttributes:m,maxVertexUniforms:b,maxVaryings:C,maxFragmentUniforms:E,maxSamples:I,samples:T}}function WE(n){let e=this,t=null,i=0,s=!1,r=!1,o=new ci,a=new tt,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(u,d){let f=u.length!==0||d||i!==0||s;return s=d,i=u.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(u,d){t=h(u,d,0)},this.setState=function(u,d,f){let g=u.clippingPlanes,v=u.clipIntersection,p=u.clipShadows,m=n.get(u);if(!s||g===null||g.length===0||r&&!p)r?h(null):l();else{let b=r?0:i,C=b*4,E=m.clippingState||null;c.value=E,E=h(g,d,C,f);for(let I=0;I!==C;++I)E[I]=t[I];m.clippingState=E,this.numIntersection=v?this.numPlanes:0,this.numPlanes+=b}};function l(){c.value!==t&&(c.value=t,c.needsUpdate=i>0),e.numPlanes=i,e.numIntersection=0}function h(u,d,f,g){let v=u!==null?u.length:0,p=null;if(v!==0){if(p=c.value,g!==!0||p===null){let m=f+v*4,b=d.matrixWorldInverse;a.getNormalMatrix(b),(p===null||p.length<m)&&(p=new Float32Array(m));for(let C=0,E=f;C!==v;++C,E+=4)o.copy(u[C]).applyMatrix4(b,a),o.normal.toArray(p,E),p[E+3]=o.constant}c.value=p,c.needsUpdate=!0}return e.numPlanes=v,e.numIntersection=0,p}}var el=class extends hi{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let i={width:e,height:e,depth:1},s=[i,i,i,i,i,i];this.texture=new Na(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let i={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new nr(5,5,5),r=new wi({name:"CubemapFromEquirect",uniforms:Lr(i.uniforms),vertexShader:i.vertexShader,fragmentShader:i.fragmentShader,side:$n,blending:Cr});r.uniforms.tEquirect.value=t;let o=new di(s,r),a=t.minFilter;return t.minFilter===Ps&&(t.minFilter=Fn),new wo(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t=!0,i=!0,s=!0){let r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,i,s);e.setRenderTarget(r)}},K0=256,XE=3,YE=20,__=256,y_=16,ZE=3,KE=new H,$E=new _t,Vu=class n{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new wo(1,10,null),this._boxMesh=new di(new nr(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,i=.1,s=100,r={}){let{size:o=256,position:a=KE}=r,c=this._renderer;this._setSize(o);let l=this._allocateTarget(),h=this._getSourceTarget(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let u=c.autoClear,d=c.autoClearColor,f=c.autoClearDepth,g=c.autoClearStencil,v=e.background;c.autoClear=!0,c.autoClearColor=!0,c.autoClearDepth=!0,c.autoClearStencil=!0,v===null&&(e.background=c.getClearColor($E));let p=new wo(i,s,h);return p.position.copy(a),p.update(c,e),c.autoClear=u,c.autoClearColor=d,c.autoClearDepth=f,c.autoClearStencil=g,e.background=v,t>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(l,t)),this._applyPMREM(l),l}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=J0(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=q0(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(K0,xf(e))}_fromTexture(e,t){e.mapping===Nr||e.mapping===No?this._setSize(e.image.length===0?K0:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let i=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(i),i}_allocateTarget(){let e=this._cubeSize,t=$0(e,!1,!1),i=Math.log2(e)-XE;for(let s=0;s<=i;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,i=this._sourceTarget;return(i===null||i.width!==t||e&&i.depthBuffer===!1)&&(i!==null&&i.dispose(),this._sourceTarget=$0(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,i){let s=this._boxMesh,r=this._cubeCamera;s.material=i,r.renderTarget=e,r.activeMipmapLevel=t;let o=e.width>>t;e.viewport.set(0,0,o,o),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===Nr||e.mapping===No?(this._cubemapMaterial===null&&(this._cubemapMaterial=J0()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=q0()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=qE(),this._integrationMaterial=JE());let t=this._cubeSize,i=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/y_);for(let o=0;o<=i;o++){let a=n.lodToRoughness(o,i);if(o>i-ZE)r.roughness.value=a,this._renderCube(e,o,this._integrationMaterial);else{let c=a>0?Math.log2(t)+.5*Math.log2(6/(__*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=c,this._renderCube(e,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=jE());let i=this._blurMaterial,s=i.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,i),s.envMap.value=e.texture,this._renderCube(r,0,i)}};function $0(n,e,t){return new el(n,{minFilter:Ps,generateMipmaps:e,type:Hi,colorSpace:Ar,depthBuffer:t})}function tl(n,e,t){return new wi({name:n,uniforms:e,vertexShader:ct.cube_vert,fragmentShader:t,side:$n,blending:Cr,depthTest:!1,depthWrite:!1})}function qE(){return tl("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${__}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function JE(){return tl("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:y_}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function jE(){return tl("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${YE}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function q0(){return tl("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function J0(){return tl("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function QE(n){let e=new WeakMap,t=new WeakMap,i=null;function s(d,f=!1){return d==null?null:f?o(d):r(d)}function r(d){if(d&&d.isTexture){let f=d.mapping;if(f===eu||f===tu)if(e.has(d)){let g=e.get(d).texture;return a(g,d.mapping)}else{let g=d.image;if(g&&g.height>0){let v=new el(g.height);return v.fromEquirectangularTexture(n,d),e.set(d,v),d.addEventListener("dispose",l),a(v.texture,d.mapping)}else return null}}return d}function o(d){if(d&&d.isTexture&&d.isPMREMTexture!==!0){let f=d.mapping,g=f===eu||f===tu,v=f===Nr||f===No;if(g||v){let p=t.get(d),m=p!==void 0?p.texture.pmremVersion:0;if(d.isRenderTargetTexture&&d.pmremVersion!==m)return i===null&&(i=new Vu(n)),p=g?i.fromEquirectangular(d,p):i.fromCubemap(d,p),p.texture.pmremVersion=d.pmremVersion,t.set(d,p),p.texture;if(p!==void 0)return p.texture;{let b=d.image;return g&&b&&b.height>0||v&&b&&c(b)?(i===null&&(i=new Vu(n)),p=g?i.fromEquirectangular(d):i.fromCubemap(d),p.texture.pmremVersion=d.pmremVersion,t.set(d,p),d.addEventListener("dispose",h),p.texture):null}}}return d}function a(d,f){return f===eu?d.mapping=Nr:f===tu&&(d.mapping=No),d}function c(d){let f=0,g=6;for(let v=0;v<g;v++)d[v]!==void 0&&f++;return f===g}function l(d){let f=d.target;f.removeEventListener("dispose",l);let g=e.get(f);g!==void 0&&(e.delete(f),g.dispose())}function h(d){let f=d.target;f.removeEventListener("dispose",h);let g=t.get(f);g!==void 0&&(t.delete(f),g.dispose())}function u(){e=new WeakMap,t=new WeakMap,i!==null&&(i.dispose(),i=null)}return{get:s,dispose:u}}function eA(n){let e={};function t(i){if(e[i]!==void 0)return e[i];let s=n.getExtension(i);return e[i]=s,s}return{has:function(i){return t(i)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(i){let s=t(i);return s===null&&va("WebGLRenderer: "+i+" extension not supported."),s}}}function tA(n,e,t,i){let s={},r=new WeakMap,o=new FinalizationRegistry(g=>delete s[g]);function a(g){c(g.target)}function c(g){g.index!==null&&e.remove(g.index);for(let p in g.attributes)e.remove(g.attributes[p]);g.removeEventListener("dispose",a),delete s[g.id],o.unregister(g);let v=r.get(g);v&&(e.remove(v),r.delete(g)),i.releaseStatesOfGeometry(g),g.isInstancedBufferGeometry===!0&&delete g._maxInstanceCount,t.memory.geometries--}function l(g,v){return s[v.id]!==void 0||(v.addEventListener("dispose",a),s[v.id]=new WeakRef(v),o.register(v,v.id,v),t.memory.geometries++),v}function h(g){let v=g.attributes;for(let p in v)e.update(v[p],n.ARRAY_BUFFER)}function u(g){let v=g.index,p=g.attributes.position,m=0;if(p===void 0)return;let b=v!==null?v.array.length:p.array.length/3-1,C=p.count>=65535?Ca:Ra,E=new C(Math.ceil(b/3)*6,1),I=E.array;if(v!==null){let y=v.array;m=v.version;for(let A=0,B=0;A<b;A+=3){let D=y[A+0],L=y[A+1],k=y[A+2];I[B++]=D,I[B++]=L,I[B++]=L,I[B++]=k,I[B++]=k,I[B++]=D}}else{m=p.version;for(let y=0,A=0;y<b;y+=3){let B=y+0,D=y+1,L=y+2;I[A++]=B,I[A++]=D,I[A++]=D,I[A++]=L,I[A++]=L,I[A++]=B}}E.version=m;let T=r.get(g);T&&e.remove(T),r.set(g,E)}function d(g){let v=r.get(g);if(v){let p=g.index;p!==null&&v.version<p.version&&u(g)}else u(g);return r.get(g)}function f(){for(let g in s){let v=s[g].deref();v!==void 0&&c(v)}}return{get:l,update:h,getWireframeAttribute:d,dispose:f}}function nA(n,e,t){let i;function s(u){i=u}let r,o;function a(u){r=u.type,o=u.bytesPerElement}function c(u,d){n.drawElements(i,d,r,u*o),t.update(d,i,1)}function l(u,d,f){f!==0&&(n.drawElementsInstanced(i,d,r,u*o,f),t.update(d,i,f))}function h(u,d,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(i,d,0,r,u,0,f);let v=0;for(let p=0;p<f;p++)v+=d[p];t.update(v,i,1)}this.setMode=s,this.setIndex=a,this.render=c,this.renderInstances=l,this.renderMultiDraw=h}function iA(n){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function i(r,o,a){switch(t.calls++,o){case n.TRIANGLES:t.triangles+=a*(r/3);break;case n.LINES:t.lines+=a*(r/2);break;case n.LINE_STRIP:t.lines+=a*(r-1);break;case n.LINE_LOOP:t.lines+=a*r;break;case n.POINTS:t.points+=a*r;break;default:Qe("WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:i}}function sA(n,e,t){let i=new WeakMap,s=new Jt;function r(o,a,c){let l=o.morphTargetInfluences,h=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,u=h!==void 0?h.length:0,d=i.get(a);if(d===void 0||d.count!==u){let B=function(){y.dispose(),i.delete(a),a.removeEventListener("dispose",B)};d!==void 0&&d.texture.dispose();let f=a.morphAttributes.position!==void 0,g=a.morphAttributes.normal!==void 0,v=a.morphAttributes.color!==void 0,p=a.morphAttributes.position||[],m=a.morphAttributes.normal||[],b=a.morphAttributes.color||[],C=0;f===!0&&(C=1),g===!0&&(C=2),v===!0&&(C=3);let E=a.attributes.position.count*C,I=1;E>e.maxTextureSize&&(I=Math.ceil(E/e.maxTextureSize),E=e.maxTextureSize);let T=new Float32Array(E*I*4*u),y=new Ta(T,E,I,u);y.type=mi,y.needsUpdate=!0;let A=C*4;for(let D=0;D<u;D++){let L=p[D],k=m[D],z=b[D],P=E*I*4*D;for(let W=0;W<L.count;W++){let K=W*A;f===!0&&(s.fromBufferAttribute(L,W),T[P+K+0]=s.x,T[P+K+1]=s.y,T[P+K+2]=s.z,T[P+K+3]=0),g===!0&&(s.fromBufferAttribute(k,W),T[P+K+4]=s.x,T[P+K+5]=s.y,T[P+K+6]=s.z,T[P+K+7]=0),v===!0&&(s.fromBufferAttribute(z,W),T[P+K+8]=s.x,T[P+K+9]=s.y,T[P+K+10]=s.z,T[P+K+11]=z.itemSize===4?s.w:1)}}d={count:u,texture:y,size:new $e(E,I)},i.set(a,d),a.addEventListener("dispose",B)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)c.getUniforms().setValue(n,"morphTexture",o.morphTexture,t);else{let f=0;for(let v=0;v<l.length;v++)f+=l[v];let g=a.morphTargetsRelative?1:1-f;c.getUniforms().setValue(n,"morphTargetBaseInfluence",g),c.getUniforms().setValue(n,"morphTargetInfluences",l)}c.getUniforms().setValue(n,"morphTargetsTexture",d.texture,t),c.getUniforms().setValue(n,"morphTargetsTextureSize",d.size)}return{update:r}}function rA(n,e,t,i,s){let r=new WeakMap;function o(l){let h=s.render.frame,u=l.geometry,d=e.get(l,u);if(r.get(d)!==h&&(e.update(d),r.set(d,h)),l.isInstancedMesh&&(l.hasEventListener("dispose",c)===!1&&l.addEventListener("dispose",c),r.get(l)!==h&&(t.update(l.instanceMatrix,n.ARRAY_BUFFER),l.instanceColor!==null&&t.update(l.instanceColor,n.ARRAY_BUFFER),r.set(l,h))),l.isSkinnedMesh){let f=l.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return d}function a(){r=new WeakMap}function c(l){let h=l.target;h.removeEventListener("dispose",c),i.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:o,dispose:a}}var oA={[jd]:"LINEAR_TONE_MAPPING",[Qd]:"REINHARD_TONE_MAPPING",[ef]:"CINEON_TONE_MAPPING",[tf]:"ACES_FILMIC_TONE_MAPPING",[sf]:"AGX_TONE_MAPPING",[rf]:"NEUTRAL_TONE_MAPPING",[nf]:"CUSTOM_TONE_MAPPING"};function aA(n,e,t,i,s,r){let o=new hi(e,t,{type:n,depthBuffer:s,stencilBuffer:r,samples:i?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,c=null,l=null,h=new Ln;h.setAttribute("position",new vn([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new vn([0,2,0,0,2,0],2));let u=new kc({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),d=new di(h,u),f=new jc(-1,1,1,-1,0,1),g=null,v=null,p=!1,m,b=null,C=[],E=!1;this.setSize=function(I,T){o.setSize(I,T),a!==null&&a.setSize(I,T),c!==null&&c.setSize(I,T);for(let y=0;y<C.length;y++){let A=C[y];A.setSize&&A.setSize(I,T)}},this.setEffects=function(I){C=I,E=C.length>0&&C[0].isRenderPass===!0;let T=o.width,y=o.height;C.length>0&&a===null&&(a=new hi(T,y,{type:Hi,depthBuffer:!1,stencilBuffer:!1}),c=new hi(T,y,{type:Hi,depthBuffer:!1,stencilBuffer:!1}));let A=s===!0&&C.some(B=>B.needsDepthTexture===!0);A!==(o.depthTexture!==null)&&(A===!0&&l===null&&(l=new Ns(T,y),r===!0&&(l.format=Ls,l.type=Pr)),o.dispose(),o.depthTexture=A?l:null,o.resolveDepthBuffer=A,o.storeMultisampledDepthBuffer=A);for(let B=0;B<C.length;B++){let D=C[B];D.setSize&&D.setSize(T,y),A&&D.needsDepthTexture===!0&&D.setDepthTexture&&D.setDepthTexture(l)}},this.begin=function(I,T){if(p||I.toneMapping===rs&&C.length===0)return!1;if(b=T,T!==null){let y=T.width,A=T.height;(o.width!==y||o.height!==A)&&this.setSize(y,A)}return E===!1&&I.setRenderTarget(o),m=I.toneMapping,I.toneMapping=rs,!0},this.hasRenderPass=function(){return E},this.end=function(I,T){I.toneMapping=m,p=!0;let y=o,A=a;for(let B=0;B<C.length;B++){let D=C[B];D.enabled!==!1&&(D.render(I,A,y,T),D.needsSwap!==!1&&(y=A,A=A===a?c:a))}if(g!==I.outputColorSpace||v!==I.toneMapping){g=I.outputColorSpace,v=I.toneMapping,u.defines={},gt.getTransfer(g)===wt&&(u.defines.SRGB_TRANSFER="");let B=oA[v];B&&(u.defines[B]=""),u.needsUpdate=!0}u.uniforms.tDiffuse.value=y.texture,I.setRenderTarget(b),I.render(d,f),b=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),c!==null&&c.dispose(),h.dispose(),u.dispose()}}var x_=new Qn,v_=new Ns(1,1),b_=new Pa(1),S_=new Ta,M_=new Lc,E_=new Na,j0=[],Q0=[],e_=new Float32Array(16),t_=new Float32Array(9),n_=new Float32Array(4);function Fo(n,e,t){let i=n[0];if(i<=0||i>0)return n;let s=e*t,r=j0[s];if(r===void 0&&(r=new Float32Array(s),j0[s]=r),e!==0){i.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,n[o].toArray(r,a)}return r}function bn(n,e){if(n.length!==e.length)return!1;for(let t=0,i=n.length;t<i;t++)if(n[t]!==e[t])return!1;return!0}function Sn(n,e){for(let t=0,i=e.length;t<i;t++)n[t]=e[t]}function Hu(n,e){let t=Q0[e];t===void 0&&(t=new Int32Array(e),Q0[e]=t);for(let i=0;i!==e;++i)t[i]=n.allocateTextureUnit();return t}function lA(n,e){let t=this.cache;t[0]!==e&&(n.uniform1f(this.addr,e),t[0]=e)}function cA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;n.uniform2fv(this.addr,e),Sn(t,e)}}function uA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(n.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(bn(t,e))return;n.uniform3fv(this.addr,e),Sn(t,e)}}function hA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;n.uniform4fv(this.addr,e),Sn(t,e)}}function dA(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(bn(t,e))return;n.uniformMatrix2fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,i))return;n_.set(i),n.uniformMatrix2fv(this.addr,!1,n_),Sn(t,i)}}function fA(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(bn(t,e))return;n.uniformMatrix3fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,i))return;t_.set(i),n.uniformMatrix3fv(this.addr,!1,t_),Sn(t,i)}}function pA(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(bn(t,e))return;n.uniformMatrix4fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,i))return;e_.set(i),n.uniformMatrix4fv(this.addr,!1,e_),Sn(t,i)}}function mA(n,e){let t=this.cache;t[0]!==e&&(n.uniform1i(this.addr,e),t[0]=e)}function gA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;n.uniform2iv(this.addr,e),Sn(t,e)}}function _A(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(bn(t,e))return;n.uniform3iv(this.addr,e),Sn(t,e)}}function yA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;n.uniform4iv(this.addr,e),Sn(t,e)}}function xA(n,e){let t=this.cache;t[0]!==e&&(n.uniform1ui(this.addr,e),t[0]=e)}function vA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;n.uniform2uiv(this.addr,e),Sn(t,e)}}function bA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(bn(t,e))return;n.uniform3uiv(this.addr,e),Sn(t,e)}}function SA(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;n.uniform4uiv(this.addr,e),Sn(t,e)}}function Wu(n){return n.version===0&&(n.compareFunction=gf,n.needsUpdate=!0),n}function MA(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_2D_SHADOW?r=Wu(v_):r=x_,t.setTexture2D(e||r,s)}function EA(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture3D(e||M_,s)}function AA(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_CUBE_SHADOW?r=Wu(b_):r=E_,t.setTextureCube(e||r,s)}function TA(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture2DArray(e||S_,s)}function wA(n){switch(n){case 5126:return lA;case 35664:return cA;case 35665:return uA;case 35666:return hA;case 35674:return dA;case 35675:return fA;case 35676:return pA;case 5124:case 35670:return mA;case 35667:case 35671:return gA;case 35668:case 35672:return _A;case 35669:case 35673:return yA;case 5125:return xA;case 36294:return vA;case 36295:return bA;case 36296:return SA;case 35678:case 36198:case 36298:case 36306:case 35682:return MA;case 35679:case 36299:case 36307:return EA;case 35680:case 36300:case 36308:case 36293:return AA;case 36289:case 36303:case 36311:case 36292:return TA}}function RA(n,e){n.uniform1fv(this.addr,e)}function CA(n,e){let t=Fo(e,this.size,2);n.uniform2fv(this.addr,t)}function IA(n,e){let t=Fo(e,this.size,3);n.uniform3fv(this.addr,t)}function NA(n,e){let t=Fo(e,this.size,4);n.uniform4fv(this.addr,t)}function PA(n,e){let t=Fo(e,this.size,4);n.uniformMatrix2fv(this.addr,!1,t)}function LA(n,e){let t=Fo(e,this.size,9);n.uniformMatrix3fv(this.addr,!1,t)}function DA(n,e){let t=Fo(e,this.size,16);n.uniformMatrix4fv(this.addr,!1,t)}function FA(n,e){n.uniform1iv(this.addr,e)}function UA(n,e){n.uniform2iv(this.addr,e)}function OA(n,e){n.uniform3iv(this.addr,e)}function BA(n,e){n.uniform4iv(this.addr,e)}function kA(n,e){n.uniform1uiv(this.addr,e)}function GA(n,e){n.uniform2uiv(this.addr,e)}function VA(n,e){n.uniform3uiv(this.addr,e)}function zA(n,e){n.uniform4uiv(this.addr,e)}function HA(n,e,t){let i=this.cache,s=e.length,r=Hu(t,s);bn(i,r)||(n.uniform1iv(this.addr,r),Sn(i,r));let o;this.type===n.SAMPLER_2D_SHADOW?o=Wu(v_):o=x_;for(let a=0;a!==s;++a)t.setTexture2D(e[a]||o,r[a])}function WA(n,e,t){let i=this.cache,s=e.length,r=Hu(t,s);bn(i,r)||(n.uniform1iv(this.addr,r),Sn(i,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||M_,r[o])}function XA(n,e,t){let i=this.cache,s=e.length,r=Hu(t,s);bn(i,r)||(n.uniform1iv(this.addr,r),Sn(i,r));let o;this.type===n.SAMPLER_CUBE_SHADOW?o=Wu(b_):o=E_;for(let a=0;a!==s;++a)t.setTextureCube(e[a]||o,r[a])}function YA(n,e,t){let i=this.cache,s=e.length,r=Hu(t,s);bn(i,r)||(n.uniform1iv(this.addr,r),Sn(i,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||S_,r[o])}function ZA(n){switch(n){case 5126:return RA;case 35664:return CA;case 35665:return IA;case 35666:return NA;case 35674:return PA;case 35675:return LA;case 35676:return DA;case 5124:case 35670:return FA;case 35667:case 35671:return UA;case 35668:case 35672:return OA;case 35669:case 35673:return BA;case 5125:return kA;case 36294:return GA;case 36295:return VA;case 36296:return zA;case 35678:case 36198:case 36298:case 36306:case 35682:return HA;case 35679:case 36299:case 36307:return WA;case 35680:case 36300:case 36308:case 36293:return XA;case 36289:case 36303:case 36311:case 36292:return YA}}var Rf=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.setValue=wA(t.type)}},Cf=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=ZA(t.type)}},If=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,i){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(e,t[a.id],i)}}},Tf=/(\w+)(\])?(\[|\.)?/g;function i_(n,e){n.seq.push(e),n.map[e.id]=e}function KA(n,e,t){let i=n.name,s=i.length;for(Tf.lastIndex=0;;){let r=Tf.exec(i),o=Tf.lastIndex,a=r[1],c=r[2]==="]",l=r[3];if(c&&(a=a|0),l===void 0||l==="["&&o+2===s){i_(t,l===void 0?new Rf(a,n,e):new Cf(a,n,e));break}else{let u=t.map[a];u===void 0&&(u=new If(a),i_(t,u)),t=u}}}var Do=class{constructor(e,t){this.seq=[],this.map={};let i=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let o=0;o<i;++o){let a=e.getActiveUniform(t,o),c=e.getUniformLocation(t,a.name);KA(a,c,this)}let s=[],r=[];for(let o of this.seq)o.type===e.SAMPLER_2D_SHADOW||o.type===e.SAMPLER_CUBE_SHADOW||o.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,i,s){let r=this.map[t];r!==void 0&&r.setValue(e,i,s)}setOptional(e,t,i){let s=t[i];s!==void 0&&this.setValue(e,i,s)}static upload(e,t,i,s){for(let r=0,o=t.length;r!==o;++r){let a=t[r],c=i[a.id];c.needsUpdate!==!1&&a.setValue(e,c.value,s)}}static seqWithValue(e,t){let i=[];for(let s=0,r=e.length;s!==r;++s){let o=e[s];o.id in t&&i.push(o)}return i}};function s_(n,e,t){let i=n.createShader(e);return n.shaderSource(i,t),n.compileShader(i),i}var $A=37297,qA=0;function JA(n,e){let t=n.split(`
`),i=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){let a=o+1;i.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return i.join(`
`)}var r_=new tt;function jA(n){gt._getMatrix(r_,gt.workingColorSpace,n);let e=`mat3( ${r_.elements.map(t=>t.toFixed(4))} )`;switch(gt.getTransfer(n)){case Ma:return[e,"LinearTransferOETF"];case wt:return[e,"sRGBTransferOETF"];default:return Ze("WebGLProgram: Unsupported color space: ",n),[e,"LinearTransferOETF"]}}function o_(n,e,t){let i=n.getShaderParameter(e,n.COMPILE_STATUS),r=(n.getShaderInfoLog(e)||"").trim();if(i&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return t.toUpperCase()+`

`+r+`

`+JA(n.getShaderSource(e),a)}else return r}function QA(n,e){let t=jA(e);return[`vec4 ${n}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var eT={[jd]:"Linear",[Qd]:"Reinhard",[ef]:"Cineon",[tf]:"ACESFilmic",[sf]:"AgX",[rf]:"Neutral",[nf]:"Custom"};function tT(n,e){let t=eT[e];return t===void 0?(Ze("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+n+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+n+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var Gu=new H;function nT(){gt.getLuminanceCoefficients(Gu);let n=Gu.x.toFixed(4),e=Gu.y.toFixed(4),t=Gu.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${n}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function iT(n){return[n.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",n.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Qa).join(`
`)}function sT(n){let e=[];for(let t in n){let i=n[t];i!==!1&&e.push("#define "+t+" "+i)}return e.join(`
`)}function rT(n,e){let t={},i=n.getProgramParameter(e,n.ACTIVE_ATTRIBUTES);for(let s=0;s<i;s++){let r=n.getActiveAttrib(e,s),o=r.name,a=1;r.type===n.FLOAT_MAT2&&(a=2),r.type===n.FLOAT_MAT3&&(a=3),r.type===n.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:n.getAttribLocation(e,o),locationSize:a}}return t}function Qa(n){return n!==""}function a_(n,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return n.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function l_(n,e){return n.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var oT=/^[ \t]*#include +<([\w\d./]+)>/gm;function Nf(n){return n.replace(oT,aT)}function aT(n,e){let t=ct[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Nf(t)}var lT=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function c_(n){return n.replace(lT,cT)}function cT(n,e,t,i){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=i.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function u_(n){let e=`precision ${n.precision} float;
	precision ${n.precision} int;
	precision ${n.precision} sampler2D;
	precision ${n.precision} samplerCube;
	precision ${n.precision} sampler3D;
	precision ${n.precision} sampler2DArray;
	precision ${n.precision} sampler2DShadow;
	precision ${n.precision} samplerCubeShadow;
	precision ${n.precision} sampler2DArrayShadow;
	precision ${n.precision} isampler2D;
	precision ${n.precision} isampler3D;
	precision ${n.precision} isamplerCube;
	precision ${n.precision} isampler2DArray;
	precision ${n.precision} usampler2D;
	precision ${n.precision} usampler3D;
	precision ${n.precision} usamplerCube;
	precision ${n.precision} usampler2DArray;
	`;return n.precision==="highp"?e+=`
#define HIGH_PRECISION`:n.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:n.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var uT={[za]:"SHADOWMAP_TYPE_PCF",[Co]:"SHADOWMAP_TYPE_VSM"};function hT(n){return uT[n.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var dT={[No]:"ENVMAP_MODE_REFRACTION"};function fT(n){return n.envMap===!1?"ENVMAP_MODE_REFLECTION":dT[n.envMapMode]||"ENVMAP_MODE_REFLECTION"}var pT={[Jd]:"ENVMAP_BLENDING_MULTIPLY",[T0]:"ENVMAP_BLENDING_MIX",[w0]:"ENVMAP_BLENDING_ADD"};function mT(n){return n.envMap===!1?"ENVMAP_BLENDING_NONE":pT[n.combine]||"ENVMAP_BLENDING_NONE"}function gT(n,e,t,i){let s=n.getContext(),r=t.defines,o=t.vertexShader,a=t.fragmentShader,c=hT(t),l=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=fT(t),u=mT(t),d=iT(t),f=sT(r),g=s.createProgram(),v,p,m=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(v=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Qa).join(`
`),v.length>0&&(v+=`
`),p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Qa).join(`
`),p.length>0&&(p+=`
`)):(v=[u_(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+c:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Qa).join(`
`),p=[u_(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+l:"",t.envMap?"#define "+h:"",t.envMap?"#define "+u:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+c:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==rs?"#define TONE_MAPPING":"",t.toneMapping!==rs?ct.tonemapping_pars_fragment:"",t.toneMapping!==rs?tT("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",ct.colorspace_pars_fragment,QA("linearToOutputTexel",t.outputColorSpace),nT(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Qa).join(`
`)),o=Nf(o),o=a_(o,t),o=l_(o,t),a=Nf(a),a=a_(a,t),a=l_(a,t),o=c_(o),a=c_(a),t.isRawShaderMaterial!==!0&&(m=`#version 300 es
`,v=[d,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+v,p=["#define varying in",t.glslVersion===Ja?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Ja?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let b=m+v+o,C=m+p+a,E=s_(s,s.VERTEX_SHADER,b),I=s_(s,s.FRAGMENT_SHADER,C);s.attachShader(g,E),s.attachShader(g,I),t.index0AttributeName!==void 0?s.bindAttribLocation(g,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function T(D){if(n.debug.checkShaderErrors){let L=s.getProgramInfoLog(g)||"",k=s.getShaderInfoLog(E)||"",z=s.getShaderInfoLog(I)||"",P=L.trim(),W=k.trim(),K=z.trim(),V=!0,ue=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if(V=!1,typeof n.debug.onShaderError=="function")n.debug.onShaderError(s,g,E,I);else{let j=o_(s,E,"vertex"),ee=o_(s,I,"fragment");Qe("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+D.name+`
Material Type: `+D.type+`

Program Info Log: `+P+`
`+j+`
`+ee)}else P!==""?Ze("WebGLProgram: Program Info Log:",P):(W===""||K==="")&&(ue=!1);ue&&(D.diagnostics={runnable:V,programLog:P,vertexShader:{log:W,prefix:v},fragmentShader:{log:K,prefix:p}})}s.deleteShader(E),s.deleteShader(I),y=new Do(s,g),A=rT(s,g)}let y;this.getUniforms=function(){return y===void 0&&T(this),y};let A;this.getAttributes=function(){return A===void 0&&T(this),A};let B=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return B===!1&&(B=s.getProgramParameter(g,$A)),B},this.destroy=function(){i.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=qA++,this.cacheKey=e,this.usedTimes=1,this.program=g,this.vertexShader=E,this.fragmentShader=I,this}var _T=0,Pf=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,i){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(i)===!1&&(s.add(i),i.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let i of t)i.usedTimes--,i.usedTimes===0&&this.shaderCache.delete(i.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,i=t.get(e);return i===void 0&&(i=new Set,t.set(e,i)),i}_getShaderStage(e){let t=this.shaderCache,i=t.get(e);return i===void 0&&(i=new Lf(e),t.set(e,i)),i}},Lf=class{constructor(e){this.id=_T++,this.code=e,this.usedTimes=0}};function yT(n){return n===cr||n===$a||n===qa}function xT(n,e,t,i,s,r){let o=new Eo,a=new Pf,c=new Set,l=[],h=new Map,u=i.logarithmicDepthBuffer,d={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(y){return c.add(y),y===0?"uv":`uv${y}`}function g(y,A,B,D,L,k){let z=D.fog,P=L.geometry,W=y.isMeshStandardMaterial||y.isMeshLambertMaterial||y.isMeshPhongMaterial?D.environment:null,K=y.isMeshStandardMaterial||y.isMeshLambertMaterial&&!y.envMap||y.isMeshPhongMaterial&&!y.envMap,V=e.get(y.envMap||W,K),ue=d[y.type],j=i.precision;y.precision!==null&&(j=i.getMaxPrecision(y.precision),j!==y.precision&&Ze("WebGLProgram.getParameters:",y.precision,"not supported, using",j,"instead."));let ee=P.morphAttributes.position||P.morphAttributes.normal||P.morphAttributes.color,re=ee!==void 0?ee.length:0,fe=0;P.morphAttributes.position!==void 0&&(fe=1),P.morphAttributes.normal!==void 0&&(fe=2),P.morphAttributes.color!==void 0&&(fe=3);let de,te,ge,xe;if(ue){let Ce=as[ue];de=Ce.vertexShader,te=Ce.fragmentShader}else{de=y.vertexShader,te=y.fragmentShader;let Ce=a.getVertexShaderStage(y),ot=a.getFragmentShaderStage(y);a.update(y,Ce,ot),ge=Ce.id,xe=ot.id}let Re=n.getRenderTarget(),Me=n.state.buffers.depth.getReversed(),We=L.isInstancedMesh===!0,st=L.isBatchedMesh===!0,ze=!!y.map,ut=!!y.matcap,at=!!V,nt=at&&V.isPMREMTexture===!0,Kt=!!y.aoMap,Gt=!!y.lightMap,cn=!!y.bumpMap&&y.wireframe===!1,Lt=!!y.normalMap,Tn=!!y.displacementMap,xt=!!y.emissiveMap,_n=!!y.metalnessMap,jt=!!y.roughnessMap,un=y.anisotropy>0,U=y.clearcoat>0,Ie=y.diffuseRoughness>0,Ke=y.dispersion>0,rt=y.retroreflectivity>0,Ee=y.iridescence>0,Ut=y.sheen>0,Ve=y.transmission>0,Ye=un&&!!y.anisotropyMap,w=U&&!!y.clearcoatMap,x=U&&!!y.clearcoatNormalMap,Y=U&&!!y.clearcoatRoughnessMap,he=Ie&&!!y.diffuseRoughnessMap,ae=Ee&&!!y.iridescenceMap,ye=Ee&&!!y.iridescenceThicknessMap,ve=Ut&&!!y.sheenColorMap,ne=Ut&&!!y.sheenRoughnessMap,se=!!y.specularMap,me=!!y.specularColorMap,F=!!y.specularIntensityMap,oe=Ve&&!!y.transmissionMap,ie=Ve&&!!y.thicknessMap,Ae=!!y.gradientMap,_e=!!y.alphaMap,Se=y.alphaTest>0,He=!!y.alphaHash,Je=!!y.extensions,ce=rs;y.toneMapped&&(Re===null||Re.isXRRenderTarget===!0)&&(ce=n.toneMapping);let Be=nt?V.isCompressedCubeTexture?V.image[0].mipmaps:V.mipmaps:null,je={shaderID:ue,shaderType:y.type,shaderName:y.name,vertexShader:de,fragmentShader:te,defines:y.defines,customVertexShaderID:ge,customFragmentShaderID:xe,isRawShaderMaterial:y.isRawShaderMaterial===!0,glslVersion:y.glslVersion,precision:j,batching:st,batchingColor:st&&L._colorsTexture!==null,instancing:We,instancingColor:We&&L.instanceColor!==null,instancingMorph:We&&L.morphTexture!==null,outputColorSpace:Re===null?n.outputColorSpace:Re.isXRRenderTarget===!0?Re.texture.colorSpace:gt.workingColorSpace,alphaToCoverage:!!y.alphaToCoverage,map:ze,matcap:ut,envMap:at,envMapMode:at&&V.mapping,envMapPMREM:nt,envMapMaxLod:nt?Be.length-1:null,envMapSize:nt?Be[0].width:null,aoMap:Kt,lightMap:Gt,bumpMap:cn,normalMap:Lt,displacementMap:Tn,emissiveMap:xt,normalMapObjectSpace:Lt&&y.normalMapType===I0,normalMapTangentSpace:Lt&&y.normalMapType===ff,packedNormalMap:Lt&&y.normalMapType===ff&&yT(y.normalMap.format),metalnessMap:_n,roughnessMap:jt,anisotropy:un,anisotropyMap:Ye,clearcoat:U,clearcoatMap:w,clearcoatNormalMap:x,clearcoatRoughnessMap:Y,diffuseRoughness:Ie,diffuseRoughnessMap:he,dispersion:Ke,retroreflection:rt,iridescence:Ee,iridescenceMap:ae,iridescenceThicknessMap:ye,sheen:Ut,sheenColorMap:ve,sheenRoughnessMap:ne,specularMap:se,specularColorMap:me,specularIntensityMap:F,transmission:Ve,transmissionMap:oe,thicknessMap:ie,gradientMap:Ae,opaque:y.transparent===!1&&y.blending===Io&&y.alphaToCoverage===!1,alphaMap:_e,alphaTest:Se,alphaHash:He,combine:y.combine,mapUv:ze&&f(y.map.channel),aoMapUv:Kt&&f(y.aoMap.channel),lightMapUv:Gt&&f(y.lightMap.channel),bumpMapUv:cn&&f(y.bumpMap.channel),normalMapUv:Lt&&f(y.normalMap.channel),displacementMapUv:Tn&&f(y.displacementMap.channel),emissiveMapUv:xt&&f(y.emissiveMap.channel),metalnessMapUv:_n&&f(y.metalnessMap.channel),roughnessMapUv:jt&&f(y.roughnessMap.channel),anisotropyMapUv:Ye&&f(y.anisotropyMap.channel),clearcoatMapUv:w&&f(y.clearcoatMap.channel),clearcoatNormalMapUv:x&&f(y.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:Y&&f(y.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:he&&f(y.diffuseRoughnessMap.channel),iridescenceMapUv:ae&&f(y.iridescenceMap.channel),iridescenceThicknessMapUv:ye&&f(y.iridescenceThicknessMap.channel),sheenColorMapUv:ve&&f(y.sheenColorMap.channel),sheenRoughnessMapUv:ne&&f(y.sheenRoughnessMap.channel),specularMapUv:se&&f(y.specularMap.channel),specularColorMapUv:me&&f(y.specularColorMap.channel),specularIntensityMapUv:F&&f(y.specularIntensityMap.channel),transmissionMapUv:oe&&f(y.transmissionMap.channel),thicknessMapUv:ie&&f(y.thicknessMap.channel),alphaMapUv:_e&&f(y.alphaMap.channel),vertexTangents:!!P.attributes.tangent&&(Lt||un),vertexNormals:!!P.attributes.normal,vertexColors:y.vertexColors,vertexAlphas:y.vertexColors===!0&&!!P.attributes.color&&P.attributes.color.itemSize===4,pointsUvs:L.isPoints===!0&&!!P.attributes.uv&&(ze||_e),fog:!!z,useFog:y.fog===!0,fogExp2:!!z&&z.isFogExp2,flatShading:y.wireframe===!1&&(y.flatShading===!0||P.attributes.normal===void 0&&Lt===!1&&(y.isMeshLambertMaterial||y.isMeshPhongMaterial||y.isMeshStandardMaterial||y.isMeshPhysicalMaterial)),sizeAttenuation:y.sizeAttenuation===!0,logarithmicDepthBuffer:u,reversedDepthBuffer:Me,skinning:L.isSkinnedMesh===!0,hasPositionAttribute:P.attributes.position!==void 0,morphTargets:P.morphAttributes.position!==void 0,morphNormals:P.morphAttributes.normal!==void 0,morphColors:P.morphAttributes.color!==void 0,morphTargetsCount:re,morphTextureStride:fe,numSunLights:A.sun.length,numDirLights:A.directional.length,numPointLights:A.point.length,numSpotLights:A.spot.length,numSpotLightMaps:A.spotLightMap.length,numRectAreaLights:A.rectArea.length,numHemiLights:A.hemi.length,numSunLightShadows:A.sunShadowMap.length,numDirLightShadows:A.directionalShadowMap.length,numPointLightShadows:A.pointShadowMap.length,numSpotLightShadows:A.spotShadowMap.length,numSpotLightShadowsWithMaps:A.numSpotLightShadowsWithMaps,numLightProbes:A.numLightProbes,numLightProbeGrids:k.filter(Ce=>Ce.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:y.dithering,shadowMapEnabled:n.shadowMap.enabled&&B.length>0,shadowMapType:n.shadowMap.type,toneMapping:ce,decodeVideoTexture:ze&&y.map.isVideoTexture===!0&&gt.getTransfer(y.map.colorSpace)===wt,decodeVideoTextureEmissive:xt&&y.emissiveMap.isVideoTexture===!0&&gt.getTransfer(y.emissiveMap.colorSpace)===wt,premultipliedAlpha:y.premultipliedAlpha,doubleSided:y.side===Ri,flipSided:y.side===$n,useDepthPacking:y.depthPacking>=0,depthPacking:y.depthPacking||0,index0AttributeName:y.index0AttributeName,extensionClipCullDistance:Je&&y.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Je&&y.extensions.multiDraw===!0||st)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:y.customProgramCacheKey()};return je.vertexUv1s=c.has(1),je.vertexUv2s=c.has(2),je.vertexUv3s=c.has(3),c.clear(),je}function v(y){let A=[];if(y.shaderID?A.push(y.shaderID):(A.push(y.customVertexShaderID),A.push(y.customFragmentShaderID)),y.defines!==void 0)for(let B in y.defines)A.push(B),A.push(y.defines[B]);return y.isRawShaderMaterial===!1&&(p(A,y),m(A,y),A.push(n.outputColorSpace)),A.push(y.customProgramCacheKey),A.join()}function p(y,A){y.push(A.precision),y.push(A.outputColorSpace),y.push(A.envMapMode),y.push(A.envMapPMREM),y.push(A.envMapMaxLod),y.push(A.envMapSize),y.push(A.mapUv),y.push(A.alphaMapUv),y.push(A.lightMapUv),y.push(A.aoMapUv),y.push(A.bumpMapUv),y.push(A.normalMapUv),y.push(A.displacementMapUv),y.push(A.emissiveMapUv),y.push(A.metalnessMapUv),y.push(A.roughnessMapUv),y.push(A.anisotropyMapUv),y.push(A.clearcoatMapUv),y.push(A.clearcoatNormalMapUv),y.push(A.clearcoatRoughnessMapUv),y.push(A.diffuseRoughnessMapUv),y.push(A.iridescenceMapUv),y.push(A.iridescenceThicknessMapUv),y.push(A.sheenColorMapUv),y.push(A.sheenRoughnessMapUv),y.push(A.specularMapUv),y.push(A.specularColorMapUv),y.push(A.specularIntensityMapUv),y.push(A.transmissionMapUv),y.push(A.thicknessMapUv),y.push(A.combine),y.push(A.fogExp2),y.push(A.sizeAttenuation),y.push(A.morphTargetsCount),y.push(A.numSunLights),y.push(A.numDirLights),y.push(A.numPointLights),y.push(A.numSpotLights),y.push(A.numSpotLightMaps),y.push(A.numHemiLights),y.push(A.numRectAreaLights),y.push(A.numSunLightShadows),y.push(A.numDirLightShadows),y.push(A.numPointLightShadows),y.push(A.numSpotLightShadows),y.push(A.numSpotLightShadowsWithMaps),y.push(A.numLightProbes),y.push(A.numLightProbeGrids),y.push(A.shadowMapType),y.push(A.toneMapping),y.push(A.numClippingPlanes),y.push(A.numClipIntersection),y.push(A.depthPacking)}function m(y,A){o.disableAll(),A.instancing&&o.enable(0),A.instancingColor&&o.enable(1),A.instancingMorph&&o.enable(2),A.matcap&&o.enable(3),A.envMap&&o.enable(4),A.normalMapObjectSpace&&o.enable(5),A.normalMapTangentSpace&&o.enable(6),A.clearcoat&&o.enable(7),A.iridescence&&o.enable(8),A.alphaTest&&o.enable(9),A.vertexColors&&o.enable(10),A.vertexAlphas&&o.enable(11),A.vertexUv1s&&o.enable(12),A.vertexUv2s&&o.enable(13),A.vertexUv3s&&o.enable(14),A.vertexTangents&&o.enable(15),A.anisotropy&&o.enable(16),A.alphaHash&&o.enable(17),A.batching&&o.enable(18),A.dispersion&&o.enable(19),A.retroreflection&&o.enable(24),A.diffuseRoughness&&o.enable(25),A.batchingColor&&o.enable(20),A.gradientMap&&o.enable(21),A.packedNormalMap&&o.enable(22),A.vertexNormals&&o.enable(23),y.push(o.mask),o.disableAll(),A.fog&&o.enable(0),A.useFog&&o.enable(1),A.flatShading&&o.enable(2),A.logarithmicDepthBuffer&&o.enable(3),A.reversedDepthBuffer&&o.enable(4),A.skinning&&o.enable(5),A.morphTargets&&o.enable(6),A.morphNormals&&o.enable(7),A.morphColors&&o.enable(8),A.premultipliedAlpha&&o.enable(9),A.shadowMapEnabled&&o.enable(10),A.doubleSided&&o.enable(11),A.flipSided&&o.enable(12),A.useDepthPacking&&o.enable(13),A.dithering&&o.enable(14),A.transmission&&o.enable(15),A.sheen&&o.enable(16),A.opaque&&o.enable(17),A.pointsUvs&&o.enable(18),A.decodeVideoTexture&&o.enable(19),A.decodeVideoTextureEmissive&&o.enable(20),A.alphaToCoverage&&o.enable(21),A.numLightProbeGrids>0&&o.enable(22),A.hasPositionAttribute&&o.enable(23),y.push(o.mask)}function b(y){let A=d[y.type],B;if(A){let D=as[A];B=X0.clone(D.uniforms)}else B=y.uniforms;return B}function C(y,A){let B=h.get(A);return B!==void 0?++B.usedTimes:(B=new gT(n,A,y,s),l.push(B),h.set(A,B)),B}function E(y){if(--y.usedTimes===0){let A=l.indexOf(y);l[A]=l[l.length-1],l.pop(),h.delete(y.cacheKey),y.destroy()}}function I(y){a.remove(y)}function T(){a.dispose()}return{getParameters:g,getProgramCacheKey:v,getUniforms:b,acquireProgram:C,releaseProgram:E,releaseShaderCache:I,programs:l,dispose:T}}function vT(){let n=new WeakMap;function e(o){return n.has(o)}function t(o){let a=n.get(o);return a===void 0&&(a={},n.set(o,a)),a}function i(o){n.delete(o)}function s(o,a,c){n.get(o)[a]=c}function r(){n=new WeakMap}return{has:e,get:t,remove:i,update:s,dispose:r}}function bT(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.material.id!==e.material.id?n.material.id-e.material.id:n.materialVariant!==e.materialVariant?n.materialVariant-e.materialVariant:n.z!==e.z?n.z-e.z:n.id-e.id}function h_(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.z!==e.z?e.z-n.z:n.id-e.id}function d_(){let n=[],e=0,t=[],i=[],s=[];function r(){e=0,t.length=0,i.length=0,s.length=0}function o(d){let f=0;return d.isInstancedMesh&&(f+=2),d.isSkinnedMesh&&(f+=1),f}function a(d,f,g,v,p,m){let b=n[e];return b===void 0?(b={id:d.id,object:d,geometry:f,material:g,materialVariant:o(d),groupOrder:v,renderOrder:d.renderOrder,z:p,group:m},n[e]=b):(b.id=d.id,b.object=d,b.geometry=f,b.material=g,b.materialVariant=o(d),b.groupOrder=v,b.renderOrder=d.renderOrder,b.z=p,b.group=m),e++,b}function c(d,f,g,v,p,m,b){b.reversedDepth===!0&&(p=-p);let C=a(d,f,g,v,p,m);g.transmission>0?i.push(C):g.transparent===!0?s.push(C):t.push(C)}function l(d,f,g,v,p,m){let b=a(d,f,g,v,p,m);g.transmission>0?i.unshift(b):g.transparent===!0?s.unshift(b):t.unshift(b)}function h(d,f){t.length>1&&t.sort(d||bT),i.length>1&&i.sort(f||h_),s.length>1&&s.sort(f||h_)}function u(){for(let d=e,f=n.length;d<f;d++){let g=n[d];if(g.id===null)break;g.id=null,g.object=null,g.geometry=null,g.material=null,g.group=null}}return{opaque:t,transmissive:i,transparent:s,init:r,push:c,unshift:l,finish:u,sort:h}}function ST(){let n=new WeakMap;function e(i,s){let r=n.get(i),o;return r===void 0?(o=new d_,n.set(i,[o])):s>=r.length?(o=new d_,r.push(o)):o=r[s],o}function t(){n=new WeakMap}return{get:e,dispose:t}}function MT(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new H,color:new _t};break;case"SpotLight":t={position:new H,direction:new H,color:new _t,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new H,color:new _t,distance:0,decay:0};break;case"HemisphereLight":t={direction:new H,skyColor:new _t,groundColor:new _t};break;case"RectAreaLight":t={color:new _t,position:new H,halfWidth:new H,halfHeight:new H};break}return n[e.id]=t,t}}}function ET(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new $e};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new $e};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new $e,shadowCameraNear:1,shadowCameraFar:1e3};break}return n[e.id]=t,t}}}var AT=0;function TT(n,e){return(e.castShadow?2:0)-(n.castShadow?2:0)+(e.map?1:0)-(n.map?1:0)}function wT(n){let e=new MT,t=ET(),i={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let l=0;l<9;l++)i.probe.push(new H);let s=new H,r=new Ft,o=new Ft;function a(l){let h=0,u=0,d=0;for(let k=0;k<9;k++)i.probe[k].set(0,0,0);let f=0,g=0,v=0,p=0,m=0,b=0,C=0,E=0,I=0,T=0,y=0,A=0,B=0,D=0;l.sort(TT);for(let k=0,z=l.length;k<z;k++){let P=l[k],W=P.color,K=P.intensity,V=P.distance,ue=null;if(P.shadow&&P.shadow.map&&(P.shadow.map.texture.format===cr?ue=P.shadow.map.texture:ue=P.shadow.map.depthTexture||P.shadow.map.texture),P.isAmbientLight)h+=W.r*K,u+=W.g*K,d+=W.b*K;else if(P.isLightProbe){for(let j=0;j<9;j++)i.probe[j].addScaledVector(P.sh.coefficients[j],K);D++}else if(P.isSunLight){let j=e.get(P);if(j.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let ee=P.shadow,re=t.get(P);re.shadowIntensity=ee.intensity,re.shadowBias=ee.bias,re.shadowNormalBias=ee.normalBias,re.shadowRadius=ee.radius,re.shadowMapSize.copy(ee.mapSize).multiply(ee.getFrameExtents()),i.sunShadow[g]=re,i.sunShadowMap[g]=ue;let fe=ee.getViewportCount();for(let de=0;de<fe;de++)i.sunShadowMatrix[v+de]=ee.getMatrix(de),i.sunShadowCascade[v+de]=ee._cascadeData[de];v+=fe,g++}i.sun[f]=j,f++}else if(P.isDirectionalLight){let j=e.get(P);if(j.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let ee=P.shadow,re=t.get(P);re.shadowIntensity=ee.intensity,re.shadowBias=ee.bias,re.shadowNormalBias=ee.normalBias,re.shadowRadius=ee.radius,re.shadowMapSize=ee.mapSize,i.directionalShadow[p]=re,i.directionalShadowMap[p]=ue,i.directionalShadowMatrix[p]=P.shadow.matrix,I++}i.directional[p]=j,p++}else if(P.isSpotLight){let j=e.get(P);j.position.setFromMatrixPosition(P.matrixWorld),j.color.copy(W).multiplyScalar(K),j.distance=V,j.coneCos=Math.cos(P.angle),j.penumbraCos=Math.cos(P.angle*(1-P.penumbra)),j.decay=P.decay,i.spot[b]=j;let ee=P.shadow;if(P.map&&(i.spotLightMap[A]=P.map,A++,ee.updateMatrices(P),P.castShadow&&B++),i.spotLightMatrix[b]=ee.matrix,P.castShadow){let re=t.get(P);re.shadowIntensity=ee.intensity,re.shadowBias=ee.bias,re.shadowNormalBias=ee.normalBias,re.shadowRadius=ee.radius,re.shadowMapSize=ee.mapSize,i.spotShadow[b]=re,i.spotShadowMap[b]=ue,y++}b++}else if(P.isRectAreaLight){let j=e.get(P);j.color.copy(W).multiplyScalar(K),j.halfWidth.set(P.width*.5,0,0),j.halfHeight.set(0,P.height*.5,0),i.rectArea[C]=j,C++}else if(P.isPointLight){let j=e.get(P);if(j.color.copy(P.color).multiplyScalar(P.intensity),j.distance=P.distance,j.decay=P.decay,P.castShadow){let ee=P.shadow,re=t.get(P);re.shadowIntensity=ee.intensity,re.shadowBias=ee.bias,re.shadowNormalBias=ee.normalBias,re.shadowRadius=ee.radius,re.shadowMapSize=ee.mapSize,re.shadowCameraNear=ee.camera.near,re.shadowCameraFar=ee.camera.far,i.pointShadow[m]=re,i.pointShadowMap[m]=ue,i.pointShadowMatrix[m]=P.shadow.matrix,T++}i.point[m]=j,m++}else if(P.isHemisphereLight){let j=e.get(P);j.skyColor.copy(P.color).multiplyScalar(K),j.groundColor.copy(P.groundColor).multiplyScalar(K),i.hemi[E]=j,E++}}C>0&&(n.has("OES_texture_float_linear")===!0?(i.rectAreaLTC1=Le.LTC_FLOAT_1,i.rectAreaLTC2=Le.LTC_FLOAT_2):(i.rectAreaLTC1=Le.LTC_HALF_1,i.rectAreaLTC2=Le.LTC_HALF_2)),i.ambient[0]=h,i.ambient[1]=u,i.ambient[2]=d;let L=i.hash;(L.sunLength!==f||L.directionalLength!==p||L.pointLength!==m||L.spotLength!==b||L.rectAreaLength!==C||L.hemiLength!==E||L.numSunShadows!==g||L.numDirectionalShadows!==I||L.numPointShadows!==T||L.numSpotShadows!==y||L.numSpotMaps!==A||L.numLightProbes!==D)&&(i.sun.length=f,i.directional.length=p,i.spot.length=b,i.rectArea.length=C,i.point.length=m,i.hemi.length=E,i.sunShadow.length=g,i.sunShadowMap.length=g,i.sunShadowMatrix.length=v,i.sunShadowCascade.length=v,i.directionalShadow.length=I,i.directionalShadowMap.length=I,i.directionalShadowMatrix.length=I,i.pointShadow.length=T,i.pointShadowMap.length=T,i.pointShadowMatrix.length=T,i.spotShadow.length=y,i.spotShadowMap.length=y,i.spotLightMatrix.length=y+A-B,i.spotLightMap.length=A,i.numSpotLightShadowsWithMaps=B,i.numLightProbes=D,L.sunLength=f,L.directionalLength=p,L.pointLength=m,L.spotLength=b,L.rectAreaLength=C,L.hemiLength=E,L.numSunShadows=g,L.numDirectionalShadows=I,L.numPointShadows=T,L.numSpotShadows=y,L.numSpotMaps=A,L.numLightProbes=D,i.version=AT++)}function c(l,h){let u=0,d=0,f=0,g=0,v=0,p=0,m=h.matrixWorldInverse;for(let b=0,C=l.length;b<C;b++){let E=l[b];if(E.isSunLight){let I=i.sun[u];I.direction.setFromMatrixPosition(E.matrixWorld),I.direction.transformDirection(m),u++}else if(E.isDirectionalLight){let I=i.directional[d];I.direction.setFromMatrixPosition(E.matrixWorld),s.setFromMatrixPosition(E.target.matrixWorld),I.direction.sub(s),I.direction.transformDirection(m),d++}else if(E.isSpotLight){let I=i.spot[g];I.position.setFromMatrixPosition(E.matrixWorld),I.position.applyMatrix4(m),I.direction.setFromMatrixPosition(E.matrixWorld),s.setFromMatrixPosition(E.target.matrixWorld),I.direction.sub(s),I.direction.transformDirection(m),g++}else if(E.isRectAreaLight){let I=i.rectArea[v];I.position.setFromMatrixPosition(E.matrixWorld),I.position.applyMatrix4(m),o.identity(),r.copy(E.matrixWorld),r.premultiply(m),o.extractRotation(r),I.halfWidth.set(E.width*.5,0,0),I.halfHeight.set(0,E.height*.5,0),I.halfWidth.applyMatrix4(o),I.halfHeight.applyMatrix4(o),v++}else if(E.isPointLight){let I=i.point[f];I.position.setFromMatrixPosition(E.matrixWorld),I.position.applyMatrix4(m),f++}else if(E.isHemisphereLight){let I=i.hemi[p];I.direction.setFromMatrixPosition(E.matrixWorld),I.direction.transformDirection(m),p++}}}return{setup:a,setupView:c,state:i}}function f_(n){let e=new wT(n),t=[],i=[],s=[];function r(u){h.camera=u,t.length=0,i.length=0,s.length=0}function o(u){u.isLightProbeGrid?s.push(u):t.push(u)}function a(u){i.push(u)}function c(){e.setup(t),s.sort((u,d)=>u.priority-d.priority||u.id-d.id)}function l(u){e.setupView(t,u)}let h={lightsArray:t,shadowsArray:i,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:a}}function RT(n){let e=new WeakMap;function t(s,r=0){let o=e.get(s),a;return o===void 0?(a=new f_(n),e.set(s,[a])):r>=o.length?(a=new f_(n),o.push(a)):a=o[r],a}function i(){e=new WeakMap}return{get:t,dispose:i}}var CT=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,IT=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,NT=[new H(1,0,0),new H(-1,0,0),new H(0,1,0),new H(0,-1,0),new H(0,0,1),new H(0,0,-1)],PT=[new H(0,-1,0),new H(0,-1,0),new H(0,0,1),new H(0,0,-1),new H(0,-1,0),new H(0,-1,0)],p_=new Ft,ja=new H,wf=new H;function LT(n,e,t){let i=new wr,s=new $e,r=new $e,o=new Jt,a=new Gc,c=new Vc,l={},h=t.maxTextureSize,u={[lr]:$n,[$n]:lr,[Ri]:Ri},d=new wi({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new $e},radius:{value:4}},vertexShader:CT,fragmentShader:IT}),f=d.clone();f.defines.HORIZONTAL_PASS=1;let g=new Ln;g.setAttribute("position",new xn(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let v=new di(g,d),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=za;let m=this.type;this.render=function(T,y,A){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||T.length===0)return;this.type===a0&&(Ze("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=za);let B=n.getRenderTarget(),D=n.getActiveCubeFace(),L=n.getActiveMipmapLevel(),k=n.state;k.setBlending(Cr),k.buffers.depth.getReversed()===!0?k.buffers.color.setClear(0,0,0,0):k.buffers.color.setClear(1,1,1,1),k.buffers.depth.setTest(!0),k.setScissorTest(!1);let z=m!==this.type;z&&y.traverse(function(P){P.material&&(Array.isArray(P.material)?P.material.forEach(W=>W.needsUpdate=!0):P.material.needsUpdate=!0)});for(let P=0,W=T.length;P<W;P++){let K=T[P],V=K.shadow;if(V===void 0){Ze("WebGLShadowMap:",K,"has no shadow.");continue}if(V.autoUpdate===!1&&V.needsUpdate===!1)continue;s.copy(V.mapSize);let ue=V.getFrameExtents();s.multiply(ue),r.copy(V.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/ue.x),s.x=r.x*ue.x,V.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/ue.y),s.y=r.y*ue.y,V.mapSize.y=r.y));let j=n.state.buffers.depth.getReversed();if(V.camera._reversedDepth=j,V.map===null||z===!0){if(V.map!==null&&(V.map.depthTexture!==null&&(V.map.depthTexture.dispose(),V.map.depthTexture=null),V.map.dispose()),this.type===Co){if(K.isPointLight){Ze("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}V.map=new hi(s.x,s.y,{format:cr,type:Hi,minFilter:Fn,magFilter:Fn,generateMipmaps:!1}),V.map.texture.name=K.name+".shadowMap",V.map.depthTexture=new Ns(s.x,s.y,mi),V.map.depthTexture.name=K.name+".shadowMapDepth",V.map.depthTexture.format=Cs,V.map.depthTexture.compareFunction=null,V.map.depthTexture.minFilter=Pn,V.map.depthTexture.magFilter=Pn}else K.isPointLight?(V.map=new el(s.x),V.map.depthTexture=new Pa(s.x,zi)):(V.map=new hi(s.x,s.y),V.map.depthTexture=new Ns(s.x,s.y,zi)),V.map.depthTexture.name=K.name+".shadowMap",V.map.depthTexture.format=Cs,this.type===za?(V.map.depthTexture.compareFunction=j?mf:pf,V.map.depthTexture.minFilter=Fn,V.map.depthTexture.magFilter=Fn):(V.map.depthTexture.compareFunction=null,V.map.depthTexture.minFilter=Pn,V.map.depthTexture.magFilter=Pn);V.camera.updateProjectionMatrix()}V.map.isWebGLCubeRenderTarget!==!0&&(V.map.width!==s.x||V.map.height!==s.y)&&V.map.setSize(s.x,s.y);let ee=V.map.isWebGLCubeRenderTarget?6:V.getViewportCount();K.isPointLight!==!0&&V.updateMatrices(K,A);let re=(V.camera.layers.mask&4294967294)!==0?V.camera.layers:A.layers;for(let fe=0;fe<ee;fe++){let de=V.getCamera(fe);if(K.isPointLight){let te=V.camera,ge=V.matrix,xe=K.distance||te.far;xe!==te.far&&(te.far=xe,te.updateProjectionMatrix()),ja.setFromMatrixPosition(K.matrixWorld),te.position.copy(ja),wf.copy(te.position),wf.add(NT[fe]),te.up.copy(PT[fe]),te.lookAt(wf),te.updateMatrixWorld(),ge.makeTranslation(-ja.x,-ja.y,-ja.z),p_.multiplyMatrices(te.projectionMatrix,te.matrixWorldInverse),V._frustum.setFromProjectionMatrix(p_,te.coordinateSystem,te.reversedDepth)}if(V.map.isWebGLCubeRenderTarget)n.setRenderTarget(V.map,fe),n.clear();else{fe===0&&(n.setRenderTarget(V.map),n.clear());let te=V.getViewport(fe);o.set(r.x*te.x,r.y*te.y,r.x*te.z,r.y*te.w),k.viewport(o)}i=V.getFrustum(fe),E(y,A,de,K,re,this.type)}V.isPointLightShadow!==!0&&this.type===Co&&b(V,A),V.needsUpdate=!1}m=this.type,p.needsUpdate=!1,n.setRenderTarget(B,D,L)};function b(T,y){let A=e.update(v);d.defines.VSM_SAMPLES!==T.blurSamples&&(d.defines.VSM_SAMPLES=T.blurSamples,f.defines.VSM_SAMPLES=T.blurSamples,d.needsUpdate=!0,f.needsUpdate=!0),T.mapPass===null?T.mapPass=new hi(s.x,s.y,{format:cr,type:Hi}):(T.mapPass.width!==T.map.width||T.mapPass.height!==T.map.height)&&T.mapPass.setSize(T.map.width,T.map.height),d.uniforms.shadow_pass.value=T.map.depthTexture,d.uniforms.resolution.value.set(T.map.width,T.map.height),d.uniforms.radius.value=T.radius,n.setRenderTarget(T.mapPass),n.clear(),n.renderBufferDirect(y,null,A,d,v,null),f.uniforms.shadow_pass.value=T.mapPass.texture,f.uniforms.resolution.value.set(T.map.width,T.map.height),f.uniforms.radius.value=T.radius,n.setRenderTarget(T.map),n.clear(),n.renderBufferDirect(y,null,A,f,v,null)}function C(T,y,A,B){let D=null,L=A.isPointLight===!0?T.customDistanceMaterial:T.customDepthMaterial;if(L!==void 0)D=L;else if(D=A.isPointLight===!0?c:a,n.localClippingEnabled&&y.clipShadows===!0&&Array.isArray(y.clippingPlanes)&&y.clippingPlanes.length!==0||y.displacementMap&&y.displacementScale!==0||y.alphaMap&&y.alphaTest>0||y.map&&y.alphaTest>0||y.alphaToCoverage===!0){let k=D.uuid,z=y.uuid,P=l[k];P===void 0&&(P={},l[k]=P);let W=P[z];W===void 0&&(W=D.clone(),P[z]=W,y.addEventListener("dispose",I)),D=W}if(D.visible=y.visible,D.wireframe=y.wireframe,B===Co?D.side=y.shadowSide!==null?y.shadowSide:y.side:D.side=y.shadowSide!==null?y.shadowSide:u[y.side],D.alphaMap=y.alphaMap,D.alphaTest=y.alphaToCoverage===!0?.5:y.alphaTest,D.map=y.map,D.clipShadows=y.clipShadows,D.clippingPlanes=y.clippingPlanes,D.clipIntersection=y.clipIntersection,D.displacementMap=y.displacementMap,D.displacementScale=y.displacementScale,D.displacementBias=y.displacementBias,D.wireframeLinewidth=y.wireframeLinewidth,D.linewidth=y.linewidth,A.isPointLight===!0&&D.isMeshDistanceMaterial===!0){let k=n.properties.get(D);k.light=A}return D}function E(T,y,A,B,D,L){if(T.visible===!1)return;if(T.layers.test(D)&&(T.isMesh||T.isLine||T.isPoints)&&(T.castShadow||T.receiveShadow&&L===Co)&&(!T.frustumCulled||T.intersectsFrustum(i))){T.modelViewMatrix.multiplyMatrices(A.matrixWorldInverse,T.matrixWorld);let P=e.update(T),W=T.material;if(Array.isArray(W)){let K=P.groups;for(let V=0,ue=K.length;V<ue;V++){let j=K[V],ee=W[j.materialIndex];if(ee&&ee.visible){let re=C(T,ee,B,L);T.onBeforeShadow(n,T,y,A,P,re,j),n.renderBufferDirect(A,null,P,re,T,j),T.onAfterShadow(n,T,y,A,P,re,j)}}}else if(W.visible){let K=C(T,W,B,L);T.onBeforeShadow(n,T,y,A,P,K,null),n.renderBufferDirect(A,null,P,K,T,null),T.onAfterShadow(n,T,y,A,P,K,null)}}let z=T.children;for(let P=0,W=z.length;P<W;P++)E(z[P],y,A,B,D,L)}function I(T){T.target.removeEventListener("dispose",I);for(let A in l){let B=l[A],D=T.target.uuid;D in B&&(B[D].dispose(),delete B[D])}}}function DT(n,e){function t(){let F=!1,oe=new Jt,ie=null,Ae=new Jt(0,0,0,0);return{setMask:function(_e){ie!==_e&&!F&&(n.colorMask(_e,_e,_e,_e),ie=_e)},setLocked:function(_e){F=_e},setClear:function(_e,Se,He,Je,ce){ce===!0&&(_e*=Je,Se*=Je,He*=Je),oe.set(_e,Se,He,Je),Ae.equals(oe)===!1&&(n.clearColor(_e,Se,He,Je),Ae.copy(oe))},reset:function(){F=!1,ie=null,Ae.set(-1,0,0,0)}}}function i(){let F=!1,oe=!1,ie=null,Ae=null,_e=null;return{setReversed:function(Se){if(oe!==Se){let He=e.get("EXT_clip_control");Se?He.clipControlEXT(He.LOWER_LEFT_EXT,He.ZERO_TO_ONE_EXT):He.clipControlEXT(He.LOWER_LEFT_EXT,He.NEGATIVE_ONE_TO_ONE_EXT),oe=Se;let Je=_e;_e=null,this.setClear(Je)}},getReversed:function(){return oe},setTest:function(Se){Se?Me(n.DEPTH_TEST):We(n.DEPTH_TEST)},setMask:function(Se){ie!==Se&&!F&&(n.depthMask(Se),ie=Se)},setFunc:function(Se){if(oe&&(Se=V0[Se]),Ae!==Se){switch(Se){case bc:n.depthFunc(n.NEVER);break;case Sc:n.depthFunc(n.ALWAYS);break;case Mc:n.depthFunc(n.LESS);break;case vo:n.depthFunc(n.LEQUAL);break;case Ec:n.depthFunc(n.EQUAL);break;case Ac:n.depthFunc(n.GEQUAL);break;case Tc:n.depthFunc(n.GREATER);break;case wc:n.depthFunc(n.NOTEQUAL);break;default:n.depthFunc(n.LEQUAL)}Ae=Se}},setLocked:function(Se){F=Se},setClear:function(Se){_e!==Se&&(_e=Se,oe&&(Se=1-Se),n.clearDepth(Se))},reset:function(){F=!1,ie=null,Ae=null,_e=null,oe=!1}}}function s(){let F=!1,oe=null,ie=null,Ae=null,_e=null,Se=null,He=null,Je=null,ce=null;return{setTest:function(Be){F||(Be?Me(n.STENCIL_TEST):We(n.STENCIL_TEST))},setMask:function(Be){oe!==Be&&!F&&(n.stencilMask(Be),oe=Be)},setFunc:function(Be,je,Ce){(ie!==Be||Ae!==je||_e!==Ce)&&(n.stencilFunc(Be,je,Ce),ie=Be,Ae=je,_e=Ce)},setOp:function(Be,je,Ce){(Se!==Be||He!==je||Je!==Ce)&&(n.stencilOp(Be,je,Ce),Se=Be,He=je,Je=Ce)},setLocked:function(Be){F=Be},setClear:function(Be){ce!==Be&&(n.clearStencil(Be),ce=Be)},reset:function(){F=!1,oe=null,ie=null,Ae=null,_e=null,Se=null,He=null,Je=null,ce=null}}}let r=new t,o=new i,a=new s,c={},l=new WeakMap,h={},u={},d={},f=new WeakMap,g=[],v=null,p=!1,m=null,b=null,C=null,E=null,I=null,T=null,y=null,A=new _t(0,0,0),B=0,D=!1,L=null,k=null,z=null,P=null,W=null,K=n.getParameter(n.MAX_COMBINED_TEXTURE_IMAGE_UNITS),V=!1,ue=0,j=n.getParameter(n.VERSION);j.indexOf("WebGL")!==-1?(ue=parseFloat(/^WebGL (\d)/.exec(j)[1]),V=ue>=1):j.indexOf("OpenGL ES")!==-1&&(ue=parseFloat(/^OpenGL ES (\d)/.exec(j)[1]),V=ue>=2);let ee=null,re={},fe=n.getParameter(n.SCISSOR_BOX),de=n.getParameter(n.VIEWPORT),te=new Jt().fromArray(fe),ge=new Jt().fromArray(de);function xe(F,oe,ie,Ae){let _e=new Uint8Array(4),Se=n.createTexture();n.bindTexture(F,Se),n.texParameteri(F,n.TEXTURE_MIN_FILTER,n.NEAREST),n.texParameteri(F,n.TEXTURE_MAG_FILTER,n.NEAREST);for(let He=0;He<ie;He++)F===n.TEXTURE_3D||F===n.TEXTURE_2D_ARRAY?n.texImage3D(oe,0,n.RGBA,1,1,Ae,0,n.RGBA,n.UNSIGNED_BYTE,_e):n.texImage2D(oe+He,0,n.RGBA,1,1,0,n.RGBA,n.UNSIGNED_BYTE,_e);return Se}let Re={};Re[n.TEXTURE_2D]=xe(n.TEXTURE_2D,n.TEXTURE_2D,1),Re[n.TEXTURE_CUBE_MAP]=xe(n.TEXTURE_CUBE_MAP,n.TEXTURE_CUBE_MAP_POSITIVE_X,6),Re[n.TEXTURE_2D_ARRAY]=xe(n.TEXTURE_2D_ARRAY,n.TEXTURE_2D_ARRAY,1,1),Re[n.TEXTURE_3D]=xe(n.TEXTURE_3D,n.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),Me(n.DEPTH_TEST),o.setFunc(vo),cn(!1),Lt(Xd),Me(n.CULL_FACE),Kt(Cr);function Me(F){h[F]!==!0&&(n.enable(F),h[F]=!0)}function We(F){h[F]!==!1&&(n.disable(F),h[F]=!1)}function st(F,oe){return d[F]!==oe?(n.bindFramebuffer(F,oe),d[F]=oe,F===n.DRAW_FRAMEBUFFER&&(d[n.FRAMEBUFFER]=oe),F===n.FRAMEBUFFER&&(d[n.DRAW_FRAMEBUFFER]=oe),!0):!1}function ze(F,oe){let ie=g,Ae=!1;if(F){ie=f.get(oe),ie===void 0&&(ie=[],f.set(oe,ie));let _e=F.textures;if(ie.length!==_e.length||ie[0]!==n.COLOR_ATTACHMENT0){for(let Se=0,He=_e.length;Se<He;Se++)ie[Se]=n.COLOR_ATTACHMENT0+Se;ie.length=_e.length,Ae=!0}}else ie[0]!==n.BACK&&(ie[0]=n.BACK,Ae=!0);Ae&&n.drawBuffers(ie)}function ut(F){return v!==F?(n.useProgram(F),v=F,!0):!1}let at={[Ir]:n.FUNC_ADD,[c0]:n.FUNC_SUBTRACT,[u0]:n.FUNC_REVERSE_SUBTRACT};at[h0]=n.MIN,at[d0]=n.MAX;let nt={[f0]:n.ZERO,[p0]:n.ONE,[m0]:n.SRC_COLOR,[$d]:n.SRC_ALPHA,[b0]:n.SRC_ALPHA_SATURATE,[x0]:n.DST_COLOR,[_0]:n.DST_ALPHA,[g0]:n.ONE_MINUS_SRC_COLOR,[qd]:n.ONE_MINUS_SRC_ALPHA,[v0]:n.ONE_MINUS_DST_COLOR,[y0]:n.ONE_MINUS_DST_ALPHA,[S0]:n.CONSTANT_COLOR,[M0]:n.ONE_MINUS_CONSTANT_COLOR,[E0]:n.CONSTANT_ALPHA,[A0]:n.ONE_MINUS_CONSTANT_ALPHA};function Kt(F,oe,ie,Ae,_e,Se,He,Je,ce,Be){if(F===Cr){p===!0&&(We(n.BLEND),p=!1);return}if(p===!1&&(Me(n.BLEND),p=!0),F!==l0){if(F!==m||Be!==D){if((b!==Ir||I!==Ir)&&(n.blendEquation(n.FUNC_ADD),b=Ir,I=Ir),Be)switch(F){case Io:n.blendFuncSeparate(n.ONE,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case Yd:n.blendFunc(n.ONE,n.ONE);break;case Zd:n.blendFuncSeparate(n.ZERO,n.ONE_MINUS_SRC_COLOR,n.ZERO,n.ONE);break;case Kd:n.blendFuncSeparate(n.DST_COLOR,n.ONE_MINUS_SRC_ALPHA,n.ZERO,n.ONE);break;default:Qe("WebGLState: Invalid blending: ",F);break}else switch(F){case Io:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case Yd:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE,n.ONE,n.ONE);break;case Zd:Qe("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case Kd:Qe("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Qe("WebGLState: Invalid blending: ",F);break}C=null,E=null,T=null,y=null,A.set(0,0,0),B=0,m=F,D=Be}return}_e=_e||oe,Se=Se||ie,He=He||Ae,(oe!==b||_e!==I)&&(n.blendEquationSeparate(at[oe],at[_e]),b=oe,I=_e),(ie!==C||Ae!==E||Se!==T||He!==y)&&(n.blendFuncSeparate(nt[ie],nt[Ae],nt[Se],nt[He]),C=ie,E=Ae,T=Se,y=He),(Je.equals(A)===!1||ce!==B)&&(n.blendColor(Je.r,Je.g,Je.b,ce),A.copy(Je),B=ce),m=F,D=!1}function Gt(F,oe){F.side===Ri?We(n.CULL_FACE):Me(n.CULL_FACE);let ie=F.side===$n;oe&&(ie=!ie),cn(ie),F.blending===Io&&F.transparent===!1?Kt(Cr):Kt(F.blending,F.blendEquation,F.blendSrc,F.blendDst,F.blendEquationAlpha,F.blendSrcAlpha,F.blendDstAlpha,F.blendColor,F.blendAlpha,F.premultipliedAlpha),o.setFunc(F.depthFunc),o.setTest(F.depthTest),o.setMask(F.depthWrite),r.setMask(F.colorWrite);let Ae=F.stencilWrite;a.setTest(Ae),Ae&&(a.setMask(F.stencilWriteMask),a.setFunc(F.stencilFunc,F.stencilRef,F.stencilFuncMask),a.setOp(F.stencilFail,F.stencilZFail,F.stencilZPass)),xt(F.polygonOffset,F.polygonOffsetFactor,F.polygonOffsetUnits),F.alphaToCoverage===!0?Me(n.SAMPLE_ALPHA_TO_COVERAGE):We(n.SAMPLE_ALPHA_TO_COVERAGE)}function cn(F){L!==F&&(F?n.frontFace(n.CW):n.frontFace(n.CCW),L=F)}function Lt(F){F!==r0?(Me(n.CULL_FACE),F!==k&&(F===Xd?n.cullFace(n.BACK):F===o0?n.cullFace(n.FRONT):n.cullFace(n.FRONT_AND_BACK))):We(n.CULL_FACE),k=F}function Tn(F){F!==z&&(V&&n.lineWidth(F),z=F)}function xt(F,oe,ie){F?(Me(n.POLYGON_OFFSET_FILL),(P!==oe||W!==ie)&&(P=oe,W=ie,o.getReversed()&&(oe=-oe,ie=-ie),n.polygonOffset(oe,ie))):We(n.POLYGON_OFFSET_FILL)}function _n(F){F?Me(n.SCISSOR_TEST):We(n.SCISSOR_TEST)}function jt(F){F===void 0&&(F=n.TEXTURE0+K-1),ee!==F&&(n.activeTexture(F),ee=F)}function un(F,oe,ie){ie===void 0&&(ee===null?ie=n.TEXTURE0+K-1:ie=ee);let Ae=re[ie];Ae===void 0&&(Ae={type:void 0,texture:void 0},re[ie]=Ae),(Ae.type!==F||Ae.texture!==oe)&&(ee!==ie&&(n.activeTexture(ie),ee=ie),n.bindTexture(F,oe||Re[F]),Ae.type=F,Ae.texture=oe)}function U(){let F=re[ee];F!==void 0&&F.type!==void 0&&(n.bindTexture(F.type,null),F.type=void 0,F.texture=void 0)}function Ie(){try{n.compressedTexImage2D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Ke(){try{n.compressedTexImage3D(...arguments)}catch(F){Qe("WebGLState:",F)}}function rt(){try{n.texSubImage2D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Ee(){try{n.texSubImage3D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Ut(){try{n.compressedTexSubImage2D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Ve(){try{n.compressedTexSubImage3D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Ye(){try{n.texStorage2D(...arguments)}catch(F){Qe("WebGLState:",F)}}function w(){try{n.texStorage3D(...arguments)}catch(F){Qe("WebGLState:",F)}}function x(){try{n.texImage2D(...arguments)}catch(F){Qe("WebGLState:",F)}}function Y(){try{n.texImage3D(...arguments)}catch(F){Qe("WebGLState:",F)}}function he(F){return u[F]!==void 0?u[F]:n.getParameter(F)}function ae(F,oe){u[F]!==oe&&(n.pixelStorei(F,oe),u[F]=oe)}function ye(F){te.equals(F)===!1&&(n.scissor(F.x,F.y,F.z,F.w),te.copy(F))}function ve(F){ge.equals(F)===!1&&(n.viewport(F.x,F.y,F.z,F.w),ge.copy(F))}function ne(F,oe){let ie=l.get(oe);ie===void 0&&(ie=new WeakMap,l.set(oe,ie));let Ae=ie.get(F);Ae===void 0&&(Ae=n.getUniformBlockIndex(oe,F.name),n.uniformBlockBinding(oe,Ae,Ae),ie.set(F,Ae))}function se(F,oe,ie){let _e=l.get(oe).get(F);c[_e]!==ie&&(n.bindBufferBase(n.UNIFORM_BUFFER,_e,ie),c[_e]=ie)}function me(){n.disable(n.BLEND),n.disable(n.CULL_FACE),n.disable(n.DEPTH_TEST),n.disable(n.POLYGON_OFFSET_FILL),n.disable(n.SCISSOR_TEST),n.disable(n.STENCIL_TEST),n.disable(n.SAMPLE_ALPHA_TO_COVERAGE),n.blendEquation(n.FUNC_ADD),n.blendFunc(n.ONE,n.ZERO),n.blendFuncSeparate(n.ONE,n.ZERO,n.ONE,n.ZERO),n.blendColor(0,0,0,0),n.colorMask(!0,!0,!0,!0),n.clearColor(0,0,0,0),n.depthMask(!0),n.depthFunc(n.LESS),o.setReversed(!1),n.clearDepth(1),n.stencilMask(4294967295),n.stencilFunc(n.ALWAYS,0,4294967295),n.stencilOp(n.KEEP,n.KEEP,n.KEEP),n.clearStencil(0),n.cullFace(n.BACK),n.frontFace(n.CCW),n.polygonOffset(0,0),n.activeTexture(n.TEXTURE0),n.bindFramebuffer(n.FRAMEBUFFER,null),n.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),n.bindFramebuffer(n.READ_FRAMEBUFFER,null),n.useProgram(null),n.lineWidth(1),n.scissor(0,0,n.canvas.width,n.canvas.height),n.viewport(0,0,n.canvas.width,n.canvas.height),n.pixelStorei(n.PACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,!1),n.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),n.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,n.BROWSER_DEFAULT_WEBGL),n.pixelStorei(n.PACK_ROW_LENGTH,0),n.pixelStorei(n.PACK_SKIP_PIXELS,0),n.pixelStorei(n.PACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_ROW_LENGTH,0),n.pixelStorei(n.UNPACK_IMAGE_HEIGHT,0),n.pixelStorei(n.UNPACK_SKIP_PIXELS,0),n.pixelStorei(n.UNPACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_SKIP_IMAGES,0),h={},u={},ee=null,re={},d={},c={},f=new WeakMap,g=[],v=null,p=!1,m=null,b=null,C=null,E=null,I=null,T=null,y=null,A=new _t(0,0,0),B=0,D=!1,L=null,k=null,z=null,P=null,W=null,te.set(0,0,n.canvas.width,n.canvas.height),ge.set(0,0,n.canvas.width,n.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:Me,disable:We,bindFramebuffer:st,drawBuffers:ze,useProgram:ut,setBlending:Kt,setMaterial:Gt,setFlipSided:cn,setCullFace:Lt,setLineWidth:Tn,setPolygonOffset:xt,setScissorTest:_n,activeTexture:jt,bindTexture:un,unbindTexture:U,compressedTexImage2D:Ie,compressedTexImage3D:Ke,texImage2D:x,texImage3D:Y,pixelStorei:ae,getParameter:he,updateUBOMapping:ne,uniformBlockBinding:se,texStorage2D:Ye,texStorage3D:w,texSubImage2D:rt,texSubImage3D:Ee,compressedTexSubImage2D:Ut,compressedTexSubImage3D:Ve,scissor:ye,viewport:ve,reset:me}}function FT(n,e,t,i,s,r,o){let a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,c=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),l=new $e,h=new WeakMap,u=new Set,d,f=new WeakMap,g=new Set,v=new FinalizationRegistry(w=>g.delete(w)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function m(w,x){return p?new OffscreenCanvas(w,x):Aa("canvas")}function b(w,x,Y){let he=1,ae=Ye(w);if((ae.width>Y||ae.height>Y)&&(he=Y/Math.max(ae.width,ae.height)),he<1)if(typeof HTMLImageElement<"u"&&w instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&w instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&w instanceof ImageBitmap||typeof VideoFrame<"u"&&w instanceof VideoFrame){let ye=Math.floor(he*ae.width),ve=Math.floor(he*ae.height);d===void 0&&(d=m(ye,ve));let ne=x?m(ye,ve):d;return ne.width=ye,ne.height=ve,ne.getContext("2d").drawImage(w,0,0,ye,ve),Ze("WebGLRenderer: Texture has been resized from ("+ae.width+"x"+ae.height+") to ("+ye+"x"+ve+")."),ne}else return"data"in w&&Ze("WebGLRenderer: Image in DataTexture is too big ("+ae.width+"x"+ae.height+")."),w;return w}function C(w){return w.generateMipmaps}function E(w){n.generateMipmap(w)}function I(w){return w.isWebGLCubeRenderTarget?n.TEXTURE_CUBE_MAP:w.isWebGL3DRenderTarget?n.TEXTURE_3D:w.isWebGLArrayRenderTarget||w.isCompressedArrayTexture?n.TEXTURE_2D_ARRAY:n.TEXTURE_2D}function T(w,x,Y,he,ae,ye=!1){if(w!==null){if(n[w]!==void 0)return n[w];Ze("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+w+"'")}let ve;he&&(ve=e.get("EXT_texture_norm16"),ve||Ze("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let ne=x;if(x===n.RED&&(Y===n.FLOAT&&(ne=n.R32F),Y===n.HALF_FLOAT&&(ne=n.R16F),Y===n.UNSIGNED_BYTE&&(ne=n.R8),Y===n.UNSIGNED_SHORT&&ve&&(ne=ve.R16_EXT),Y===n.SHORT&&ve&&(ne=ve.R16_SNORM_EXT)),x===n.RED_INTEGER&&(Y===n.UNSIGNED_BYTE&&(ne=n.R8UI),Y===n.UNSIGNED_SHORT&&(ne=n.R16UI),Y===n.UNSIGNED_INT&&(ne=n.R32UI),Y===n.BYTE&&(ne=n.R8I),Y===n.SHORT&&(ne=n.R16I),Y===n.INT&&(ne=n.R32I)),x===n.RG&&(Y===n.FLOAT&&(ne=n.RG32F),Y===n.HALF_FLOAT&&(ne=n.RG16F),Y===n.UNSIGNED_BYTE&&(ne=n.RG8),Y===n.UNSIGNED_SHORT&&ve&&(ne=ve.RG16_EXT),Y===n.SHORT&&ve&&(ne=ve.RG16_SNORM_EXT)),x===n.RG_INTEGER&&(Y===n.UNSIGNED_BYTE&&(ne=n.RG8UI),Y===n.UNSIGNED_SHORT&&(ne=n.RG16UI),Y===n.UNSIGNED_INT&&(ne=n.RG32UI),Y===n.BYTE&&(ne=n.RG8I),Y===n.SHORT&&(ne=n.RG16I),Y===n.INT&&(ne=n.RG32I)),x===n.RGB_INTEGER&&(Y===n.UNSIGNED_BYTE&&(ne=n.RGB8UI),Y===n.UNSIGNED_SHORT&&(ne=n.RGB16UI),Y===n.UNSIGNED_INT&&(ne=n.RGB32UI),Y===n.BYTE&&(ne=n.RGB8I),Y===n.SHORT&&(ne=n.RGB16I),Y===n.INT&&(ne=n.RGB32I)),x===n.RGBA_INTEGER&&(Y===n.UNSIGNED_BYTE&&(ne=n.RGBA8UI),Y===n.UNSIGNED_SHORT&&(ne=n.RGBA16UI),Y===n.UNSIGNED_INT&&(ne=n.RGBA32UI),Y===n.BYTE&&(ne=n.RGBA8I),Y===n.SHORT&&(ne=n.RGBA16I),Y===n.INT&&(ne=n.RGBA32I)),x===n.RGB&&(Y===n.UNSIGNED_SHORT&&ve&&(ne=ve.RGB16_EXT),Y===n.SHORT&&ve&&(ne=ve.RGB16_SNORM_EXT),Y===n.UNSIGNED_INT_5_9_9_9_REV&&(ne=n.RGB9_E5),Y===n.UNSIGNED_INT_10F_11F_11F_REV&&(ne=n.R11F_G11F_B10F)),x===n.RGBA){let se=ye?Ma:gt.getTransfer(ae);Y===n.FLOAT&&(ne=n.RGBA32F),Y===n.HALF_FLOAT&&(ne=n.RGBA16F),Y===n.UNSIGNED_BYTE&&(ne=se===wt?n.SRGB8_ALPHA8:n.RGBA8),Y===n.UNSIGNED_SHORT&&ve&&(ne=ve.RGBA16_EXT),Y===n.SHORT&&ve&&(ne=ve.RGBA16_SNORM_EXT),Y===n.UNSIGNED_SHORT_4_4_4_4&&(ne=n.RGBA4),Y===n.UNSIGNED_SHORT_5_5_5_1&&(ne=n.RGB5_A1)}return(ne===n.R16F||ne===n.R32F||ne===n.RG16F||ne===n.RG32F||ne===n.RGBA16F||ne===n.RGBA32F)&&e.get("EXT_color_buffer_float"),ne}function y(w,x){let Y;return w?x===null||x===zi||x===Pr?Y=n.DEPTH24_STENCIL8:x===mi?Y=n.DEPTH32F_STENCIL8:x===Po&&(Y=n.DEPTH24_STENCIL8,Ze("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):x===null||x===zi||x===Pr?Y=n.DEPTH_COMPONENT24:x===mi?Y=n.DEPTH_COMPONENT32F:x===Po&&(Y=n.DEPTH_COMPONENT16),Y}function A(w,x){return C(w)===!0||w.isFramebufferTexture&&w.minFilter!==Pn&&w.minFilter!==Fn?Math.log2(Math.max(x.width,x.height))+1:w.mipmaps.length>0?w.mipmaps.length:w.isCompressedTexture&&Array.isArray(w.image)?x.mipmaps.length:1}function B(w){let x=new WeakRef(w);i.get(w).__ref=x,g.add(x),v.register(w,x,x)}function D(w){let x=i.get(w).__ref;x!==void 0&&(g.delete(x),v.unregister(x))}function L(w){z(w.target)}function k(w){P(w.target)}function z(w){w.removeEventListener("dispose",L),D(w),K(w),w.isVideoTexture&&h.delete(w),w.isHTMLTexture&&u.delete(w)}function P(w){w.removeEventListener("dispose",k),D(w),ue(w)}function W(){for(let w of g){let x=w.deref();x!==void 0&&(x.isRenderTarget===!0?P(x):z(x))}g.clear(),u.clear()}function K(w){let x=i.get(w);if(x.__webglInit===void 0)return;let Y=w.source,he=f.get(Y);if(he){let ae=he[x.__cacheKey];ae.usedTimes--,ae.usedTimes===0&&V(w),Object.keys(he).length===0&&f.delete(Y)}i.remove(w)}function V(w){let x=i.get(w);n.deleteTexture(x.__webglTexture);let Y=w.source,he=f.get(Y);delete he[x.__cacheKey],o.memory.textures--}function ue(w){let x=i.get(w);x.__depthDisposeCallback&&x.__depthDisposeCallback();let Y=w.depthTexture;if(Y&&Y.renderTarget===w&&z(Y),w.isWebGLCubeRenderTarget)for(let ae=0;ae<6;ae++){if(Array.isArray(x.__webglFramebuffer[ae]))for(let ye=0;ye<x.__webglFramebuffer[ae].length;ye++)n.deleteFramebuffer(x.__webglFramebuffer[ae][ye]);else n.deleteFramebuffer(x.__webglFramebuffer[ae]);x.__webglDepthbuffer&&n.deleteRenderbuffer(x.__webglDepthbuffer[ae])}else{if(Array.isArray(x.__webglFramebuffer))for(let ae=0;ae<x.__webglFramebuffer.length;ae++)n.deleteFramebuffer(x.__webglFramebuffer[ae]);else n.deleteFramebuffer(x.__webglFramebuffer);if(x.__webglDepthbuffer&&n.deleteRenderbuffer(x.__webglDepthbuffer),x.__webglMultisampledFramebuffer&&n.deleteFramebuffer(x.__webglMultisampledFramebuffer),x.__webglColorRenderbuffer)for(let ae=0;ae<x.__webglColorRenderbuffer.length;ae++)x.__webglColorRenderbuffer[ae]&&n.deleteRenderbuffer(x.__webglColorRenderbuffer[ae]);x.__webglDepthRenderbuffer&&n.deleteRenderbuffer(x.__webglDepthRenderbuffer)}let he=w.textures;for(let ae=0,ye=he.length;ae<ye;ae++){let ve=i.get(he[ae]);ve.__webglTexture&&(n.deleteTexture(ve.__webglTexture),o.memory.textures--),i.remove(he[ae])}i.remove(w)}let j=0;function ee(){j=0}function re(){return j}function fe(w){j=w}function de(){let w=j;return w>=s.maxTextures&&Ze("WebGLTextures: Trying to use "+(w+1)+" texture units while this GPU supports only "+s.maxTextures),j+=1,w}function te(w){let x=[];return x.push(w.wrapS),x.push(w.wrapT),x.push(w.wrapR||0),x.push(w.magFilter),x.push(w.minFilter),x.push(w.anisotropy),x.push(w.internalFormat),x.push(w.format),x.push(w.type),x.push(w.generateMipmaps),x.push(w.mipmapsAutoUpdate),x.push(w.premultiplyAlpha),x.push(w.flipY),x.push(w.unpackAlignment),x.push(w.colorSpace),x.join()}function ge(w,x){let Y=i.get(w);if(w.isVideoTexture&&Ut(w),w.isRenderTargetTexture===!1&&w.isExternalTexture!==!0&&w.version>0&&Y.__version!==w.version){let he=w.image;if(he===null)Ze("WebGLRenderer: Texture marked for update but no image data found.");else if(he.complete===!1)Ze("WebGLRenderer: Texture marked for update but image is incomplete");else{Gt(Y,w,x);return}}else w.isExternalTexture&&(Y.__webglTexture=w.sourceTexture?w.sourceTexture:null);t.bindTexture(n.TEXTURE_2D,Y.__webglTexture,n.TEXTURE0+x)}function xe(w,x){let Y=i.get(w);if(w.isRenderTargetTexture===!1&&w.version>0&&Y.__version!==w.version){Gt(Y,w,x);return}else w.isExternalTexture&&(Y.__webglTexture=w.sourceTexture?w.sourceTexture:null);t.bindTexture(n.TEXTURE_2D_ARRAY,Y.__webglTexture,n.TEXTURE0+x)}function Re(w,x){let Y=i.get(w);if(w.isRenderTargetTexture===!1&&w.version>0&&Y.__version!==w.version){Gt(Y,w,x);return}t.bindTexture(n.TEXTURE_3D,Y.__webglTexture,n.TEXTURE0+x)}function Me(w,x){let Y=i.get(w);if(w.version>0&&Y.__version!==w.version){cn(Y,w,x);return}t.bindTexture(n.TEXTURE_CUBE_MAP,Y.__webglTexture,n.TEXTURE0+x)}let We={[Rc]:n.REPEAT,[is]:n.CLAMP_TO_EDGE,[Cc]:n.MIRRORED_REPEAT},st={[Pn]:n.NEAREST,[R0]:n.NEAREST_MIPMAP_NEAREST,[Ha]:n.NEAREST_MIPMAP_LINEAR,[Fn]:n.LINEAR,[nu]:n.LINEAR_MIPMAP_NEAREST,[Ps]:n.LINEAR_MIPMAP_LINEAR},ze={[P0]:n.NEVER,[gf]:n.ALWAYS,[L0]:n.LESS,[pf]:n.LEQUAL,[D0]:n.EQUAL,[mf]:n.GEQUAL,[F0]:n.GREATER,[U0]:n.NOTEQUAL};function ut(w,x){if(x.type===mi&&e.has("OES_texture_float_linear")===!1&&(x.magFilter===Fn||x.magFilter===nu||x.magFilter===Ha||x.magFilter===Ps||x.minFilter===Fn||x.minFilter===nu||x.minFilter===Ha||x.minFilter===Ps)&&Ze("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),n.texParameteri(w,n.TEXTURE_WRAP_S,We[x.wrapS]),n.texParameteri(w,n.TEXTURE_WRAP_T,We[x.wrapT]),(w===n.TEXTURE_3D||w===n.TEXTURE_2D_ARRAY)&&n.texParameteri(w,n.TEXTURE_WRAP_R,We[x.wrapR]),n.texParameteri(w,n.TEXTURE_MAG_FILTER,st[x.magFilter]),n.texParameteri(w,n.TEXTURE_MIN_FILTER,st[x.minFilter]),x.compareFunction&&(n.texParameteri(w,n.TEXTURE_COMPARE_MODE,n.COMPARE_REF_TO_TEXTURE),n.texParameteri(w,n.TEXTURE_COMPARE_FUNC,ze[x.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(x.magFilter===Pn||x.minFilter!==Ha&&x.minFilter!==Ps||x.type===mi&&e.has("OES_texture_float_linear")===!1)return;if(x.anisotropy>1||i.get(x).__currentAnisotropy){let Y=e.get("EXT_texture_filter_anisotropic");n.texParameterf(w,Y.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(x.anisotropy,s.getMaxAnisotropy())),i.get(x).__currentAnisotropy=x.anisotropy}}}function at(w,x){let Y=!1;w.__webglInit===void 0&&(w.__webglInit=!0,x.addEventListener("dispose",L),B(x));let he=x.source,ae=f.get(he);ae===void 0&&(ae={},f.set(he,ae));let ye=te(x);if(ye!==w.__cacheKey){ae[ye]===void 0&&(ae[ye]={texture:n.createTexture(),usedTimes:0},o.memory.textures++,Y=!0),ae[ye].usedTimes++;let ve=ae[w.__cacheKey];ve!==void 0&&(ae[w.__cacheKey].usedTimes--,ve.usedTimes===0&&V(x)),w.__cacheKey=ye,w.__webglTexture=ae[ye].texture}return Y}function nt(w,x,Y){return Math.floor(Math.floor(w/Y)/x)}function Kt(w,x,Y,he){let ye=w.updateRanges;if(ye.length===0)t.texSubImage2D(n.TEXTURE_2D,0,0,0,x.width,x.height,Y,he,x.data);else{ye.sort((F,oe)=>F.start-oe.start);let ve=0;for(let F=1;F<ye.length;F++){let oe=ye[ve],ie=ye[F],Ae=oe.start+oe.count,_e=nt(ie.start,x.width,4),Se=nt(oe.start,x.width,4);ie.start<=Ae+1&&_e===Se&&nt(ie.start+ie.count-1,x.width,4)===_e?oe.count=Math.max(oe.count,ie.start+ie.count-oe.start):(++ve,ye[ve]=ie)}ye.length=ve+1;let ne=t.getParameter(n.UNPACK_ROW_LENGTH),se=t.getParameter(n.UNPACK_SKIP_PIXELS),me=t.getParameter(n.UNPACK_SKIP_ROWS);t.pixelStorei(n.UNPACK_ROW_LENGTH,x.width);for(let F=0,oe=ye.length;F<oe;F++){let ie=ye[F],Ae=Math.floor(ie.start/4),_e=Math.ceil(ie.count/4),Se=Ae%x.width,He=Math.floor(Ae/x.width),Je=_e,ce=1;t.pixelStorei(n.UNPACK_SKIP_PIXELS,Se),t.pixelStorei(n.UNPACK_SKIP_ROWS,He),t.texSubImage2D(n.TEXTURE_2D,0,Se,He,Je,ce,Y,he,x.data)}w.clearUpdateRanges(),t.pixelStorei(n.UNPACK_ROW_LENGTH,ne),t.pixelStorei(n.UNPACK_SKIP_PIXELS,se),t.pixelStorei(n.UNPACK_SKIP_ROWS,me)}}function Gt(w,x,Y){let he=n.TEXTURE_2D;(x.isDataArrayTexture||x.isCompressedArrayTexture)&&(he=n.TEXTURE_2D_ARRAY),x.isData3DTexture&&(he=n.TEXTURE_3D);let ae=at(w,x),ye=x.source;t.bindTexture(he,w.__webglTexture,n.TEXTURE0+Y);let ve=i.get(ye);if(ye.version!==ve.__version||ae===!0){if(t.activeTexture(n.TEXTURE0+Y),(typeof ImageBitmap<"u"&&x.image instanceof ImageBitmap)===!1){let ce=gt.getPrimaries(gt.workingColorSpace),Be=x.colorSpace===Ds?null:gt.getPrimaries(x.colorSpace),je=x.colorSpace===Ds||ce===Be?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,je)}t.pixelStorei(n.UNPACK_ALIGNMENT,x.unpackAlignment);let se=b(x.image,!1,s.maxTextureSize);se=Ve(x,se);let me=r.convert(x.format,x.colorSpace),F=r.convert(x.type),oe=T(x.internalFormat,me,F,x.normalized,x.colorSpace,x.isVideoTexture);ut(he,x);let ie,Ae=x.mipmaps,_e=x.isVideoTexture!==!0,Se=ve.__version===void 0||ae===!0,He=ye.dataReady,Je=A(x,se);if(x.isDepthTexture)oe=y(x.format===Ls,x.type),Se&&(_e?t.texStorage2D(n.TEXTURE_2D,1,oe,se.width,se.height):t.texImage2D(n.TEXTURE_2D,0,oe,se.width,se.height,0,me,F,null));else if(x.isDataTexture)if(Ae.length>0){_e&&Se&&t.texStorage2D(n.TEXTURE_2D,Je,oe,Ae[0].width,Ae[0].height);for(let ce=0,Be=Ae.length;ce<Be;ce++)ie=Ae[ce],_e?He&&t.texSubImage2D(n.TEXTURE_2D,ce,0,0,ie.width,ie.height,me,F,ie.data):t.texImage2D(n.TEXTURE_2D,ce,oe,ie.width,ie.height,0,me,F,ie.data);x.generateMipmaps=!1}else _e?(Se&&t.texStorage2D(n.TEXTURE_2D,Je,oe,se.width,se.height),He&&Kt(x,se,me,F)):t.texImage2D(n.TEXTURE_2D,0,oe,se.width,se.height,0,me,F,se.data);else if(x.isCompressedTexture)if(x.isCompressedArrayTexture){_e&&Se&&t.texStorage3D(n.TEXTURE_2D_ARRAY,Je,oe,Ae[0].width,Ae[0].height,se.depth);for(let ce=0,Be=Ae.length;ce<Be;ce++)if(ie=Ae[ce],x.format!==Wi)if(me!==null)if(_e){if(He)if(x.layerUpdates.size>0){let je=Af(ie.width,ie.height,x.format,x.type);for(let Ce of x.layerUpdates){let ot=ie.data.subarray(Ce*je/ie.data.BYTES_PER_ELEMENT,(Ce+1)*je/ie.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,ce,0,0,Ce,ie.width,ie.height,1,me,ot)}}else t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,ce,0,0,0,ie.width,ie.height,se.depth,me,ie.data)}else t.compressedTexImage3D(n.TEXTURE_2D_ARRAY,ce,oe,ie.width,ie.height,se.depth,0,ie.data,0,0);else Ze("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else _e?He&&t.texSubImage3D(n.TEXTURE_2D_ARRAY,ce,0,0,0,ie.width,ie.height,se.depth,me,F,ie.data):t.texImage3D(n.TEXTURE_2D_ARRAY,ce,oe,ie.width,ie.height,se.depth,0,me,F,ie.data);x.layerUpdates.size>0&&x.clearLayerUpdates()}else{_e&&Se&&t.texStorage2D(n.TEXTURE_2D,Je,oe,Ae[0].width,Ae[0].height);for(let ce=0,Be=Ae.length;ce<Be;ce++)ie=Ae[ce],x.format!==Wi?me!==null?_e?He&&t.compressedTexSubImage2D(n.TEXTURE_2D,ce,0,0,ie.width,ie.height,me,ie.data):t.compressedTexImage2D(n.TEXTURE_2D,ce,oe,ie.width,ie.height,0,ie.data):Ze("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):_e?He&&t.texSubImage2D(n.TEXTURE_2D,ce,0,0,ie.width,ie.height,me,F,ie.data):t.texImage2D(n.TEXTURE_2D,ce,oe,ie.width,ie.height,0,me,F,ie.data)}else if(x.isDataArrayTexture)if(_e){if(Se&&t.texStorage3D(n.TEXTURE_2D_ARRAY,Je,oe,se.width,se.height,se.depth),He)if(x.layerUpdates.size>0){let ce=Af(se.width,se.height,x.format,x.type);for(let Be of x.layerUpdates){let je=se.data.subarray(Be*ce/se.data.BYTES_PER_ELEMENT,(Be+1)*ce/se.data.BYTES_PER_ELEMENT);t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,Be,se.width,se.height,1,me,F,je)}x.clearLayerUpdates()}else t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,0,se.width,se.height,se.depth,me,F,se.data)}else t.texImage3D(n.TEXTURE_2D_ARRAY,0,oe,se.width,se.height,se.depth,0,me,F,se.data);else if(x.isData3DTexture)_e?(Se&&t.texStorage3D(n.TEXTURE_3D,Je,oe,se.width,se.height,se.depth),He&&t.texSubImage3D(n.TEXTURE_3D,0,0,0,0,se.width,se.height,se.depth,me,F,se.data)):t.texImage3D(n.TEXTURE_3D,0,oe,se.width,se.height,se.depth,0,me,F,se.data);else if(x.isFramebufferTexture){if(Se)if(_e)t.texStorage2D(n.TEXTURE_2D,Je,oe,se.width,se.height);else{let ce=se.width,Be=se.height;for(let je=0;je<Je;je++)t.texImage2D(n.TEXTURE_2D,je,oe,ce,Be,0,me,F,null),ce>>=1,Be>>=1}}else if(x.isHTMLTexture){if("texElementImage2D"in n){let ce=n.canvas;if(ce.hasAttribute("layoutsubtree")||ce.setAttribute("layoutsubtree","true"),se.parentNode!==ce){ce.appendChild(se),u.add(x),ce.onpaint=Be=>{let je=Be.changedElements;for(let Ce of u)je.includes(Ce.image)&&(Ce.needsUpdate=!0)},ce.requestPaint();return}if(n.texElementImage2D.length===3)n.texElementImage2D(n.TEXTURE_2D,n.RGBA8,se);else{let je=n.RGBA,Ce=n.RGBA,ot=n.UNSIGNED_BYTE;n.texElementImage2D(n.TEXTURE_2D,0,je,Ce,ot,se)}n.texParameteri(n.TEXTURE_2D,n.TEXTURE_MIN_FILTER,n.LINEAR),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_S,n.CLAMP_TO_EDGE),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_T,n.CLAMP_TO_EDGE)}}else if(Ae.length>0){if(_e&&Se){let ce=Ye(Ae[0]);t.texStorage2D(n.TEXTURE_2D,Je,oe,ce.width,ce.height)}for(let ce=0,Be=Ae.length;ce<Be;ce++)ie=Ae[ce],_e?He&&t.texSubImage2D(n.TEXTURE_2D,ce,0,0,me,F,ie):t.texImage2D(n.TEXTURE_2D,ce,oe,me,F,ie);x.generateMipmaps=!1}else if(_e){if(Se){let ce=Ye(se);t.texStorage2D(n.TEXTURE_2D,Je,oe,ce.width,ce.height)}He&&t.texSubImage2D(n.TEXTURE_2D,0,0,0,me,F,se)}else t.texImage2D(n.TEXTURE_2D,0,oe,me,F,se);C(x)&&x.mipmapsAutoUpdate===!0&&E(he),ve.__version=ye.version,x.onUpdate&&x.onUpdate(x)}w.__version=x.version}function cn(w,x,Y){if(x.image.length!==6)return;let he=at(w,x),ae=x.source;t.bindTexture(n.TEXTURE_CUBE_MAP,w.__webglTexture,n.TEXTURE0+Y);let ye=i.get(ae);if(ae.version!==ye.__version||he===!0){t.activeTexture(n.TEXTURE0+Y);let ve=gt.getPrimaries(gt.workingColorSpace),ne=x.colorSpace===Ds?null:gt.getPrimaries(x.colorSpace),se=x.colorSpace===Ds||ve===ne?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(n.UNPACK_ALIGNMENT,x.unpackAlignment),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,se);let me=x.isCompressedTexture||x.image[0].isCompressedTexture,F=x.image[0]&&x.image[0].isDataTexture,oe=[];for(let Ce=0;Ce<6;Ce++)!me&&!F?oe[Ce]=b(x.image[Ce],!0,s.maxCubemapSize):oe[Ce]=F?x.image[Ce].image:x.image[Ce],oe[Ce]=Ve(x,oe[Ce]);let ie=oe[0],Ae=r.convert(x.format,x.colorSpace),_e=r.convert(x.type),Se=T(x.internalFormat,Ae,_e,x.normalized,x.colorSpace),He=x.isVideoTexture!==!0,Je=ye.__version===void 0||he===!0,ce=ae.dataReady,Be=A(x,ie);ut(n.TEXTURE_CUBE_MAP,x);let je;if(x.isDepthTexture){if(Se=y(x.format===Ls,x.type),Je)if(He)t.texStorage2D(n.TEXTURE_CUBE_MAP,1,Se,ie.width,ie.height);else for(let Ce=0;Ce<6;Ce++)t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,Se,ie.width,ie.height,0,Ae,_e,null)}else if(me){He&&Je&&t.texStorage2D(n.TEXTURE_CUBE_MAP,Be,Se,ie.width,ie.height);for(let Ce=0;Ce<6;Ce++){je=oe[Ce].mipmaps;for(let ot=0;ot<je.length;ot++){let zt=je[ot];x.format!==Wi?Ae!==null?He?ce&&t.compressedTexSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot,0,0,zt.width,zt.height,Ae,zt.data):t.compressedTexImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot,Se,zt.width,zt.height,0,zt.data):Ze("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):He?ce&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot,0,0,zt.width,zt.height,Ae,_e,zt.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot,Se,zt.width,zt.height,0,Ae,_e,zt.data)}}}else{if(je=x.mipmaps,He&&Je){je.length>0&&Be++;let Ce=Ye(oe[0]);t.texStorage2D(n.TEXTURE_CUBE_MAP,Be,Se,Ce.width,Ce.height)}for(let Ce=0;Ce<6;Ce++)if(F){He?ce&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,oe[Ce].width,oe[Ce].height,Ae,_e,oe[Ce].data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,Se,oe[Ce].width,oe[Ce].height,0,Ae,_e,oe[Ce].data);for(let ot=0;ot<je.length;ot++){let zn=je[ot].image[Ce].image;He?ce&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot+1,0,0,zn.width,zn.height,Ae,_e,zn.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot+1,Se,zn.width,zn.height,0,Ae,_e,zn.data)}}else{He?ce&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,Ae,_e,oe[Ce]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,Se,Ae,_e,oe[Ce]);for(let ot=0;ot<je.length;ot++){let zt=je[ot];He?ce&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot+1,0,0,Ae,_e,zt.image[Ce]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ot+1,Se,Ae,_e,zt.image[Ce])}}}C(x)&&x.mipmapsAutoUpdate===!0&&E(n.TEXTURE_CUBE_MAP),ye.__version=ae.version,x.onUpdate&&x.onUpdate(x)}w.__version=x.version}function Lt(w,x,Y,he,ae,ye){let ve=r.convert(Y.format,Y.colorSpace),ne=r.convert(Y.type),se=T(Y.internalFormat,ve,ne,Y.normalized,Y.colorSpace),me=i.get(x),F=i.get(Y);if(F.__renderTarget=x,!me.__hasExternalTextures){let oe=Math.max(1,x.width>>ye),ie=Math.max(1,x.height>>ye);ae===n.TEXTURE_3D||ae===n.TEXTURE_2D_ARRAY?t.texImage3D(ae,ye,se,oe,ie,x.depth,0,ve,ne,null):t.texImage2D(ae,ye,se,oe,ie,0,ve,ne,null)}t.bindFramebuffer(n.FRAMEBUFFER,w),Ee(x)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,he,ae,F.__webglTexture,0,rt(x)):(ae===n.TEXTURE_2D||ae>=n.TEXTURE_CUBE_MAP_POSITIVE_X&&ae<=n.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&n.framebufferTexture2D(n.FRAMEBUFFER,he,ae,F.__webglTexture,ye),t.bindFramebuffer(n.FRAMEBUFFER,null)}function Tn(w,x,Y){if(n.bindRenderbuffer(n.RENDERBUFFER,w),x.depthBuffer){let he=x.depthTexture,ae=he&&he.isDepthTexture?he.type:null,ye=y(x.stencilBuffer,ae),ve=x.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;Ee(x)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,rt(x),ye,x.width,x.height):Y?n.renderbufferStorageMultisample(n.RENDERBUFFER,rt(x),ye,x.width,x.height):n.renderbufferStorage(n.RENDERBUFFER,ye,x.width,x.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,ve,n.RENDERBUFFER,w)}else{let he=x.textures;for(let ae=0;ae<he.length;ae++){let ye=he[ae],ve=r.convert(ye.format,ye.colorSpace),ne=r.convert(ye.type),se=T(ye.internalFormat,ve,ne,ye.normalized,ye.colorSpace);Ee(x)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,rt(x),se,x.width,x.height):Y?n.renderbufferStorageMultisample(n.RENDERBUFFER,rt(x),se,x.width,x.height):n.renderbufferStorage(n.RENDERBUFFER,se,x.width,x.height)}}n.bindRenderbuffer(n.RENDERBUFFER,null)}function xt(w,x,Y){let he=x.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(n.FRAMEBUFFER,w),!(x.depthTexture&&x.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let ae=i.get(x.depthTexture);ae.__renderTarget=x;let ye=he?x.depthTexture.image[0]:x.depthTexture.image;(!ae.__webglTexture||ye.width!==x.width||ye.height!==x.height)&&(ye.width=x.width,ye.height=x.height,x.depthTexture.needsUpdate=!0),he?Me(x.depthTexture,0):ge(x.depthTexture,0);let ve=ae.__webglTexture,ne=rt(x),se=he?n.TEXTURE_CUBE_MAP_POSITIVE_X+Y:n.TEXTURE_2D,me=x.depthTexture.format===Ls?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;if(x.depthTexture.format===Cs)Ee(x)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,me,se,ve,0,ne):n.framebufferTexture2D(n.FRAMEBUFFER,me,se,ve,0);else if(x.depthTexture.format===Ls)Ee(x)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,me,se,ve,0,ne):n.framebufferTexture2D(n.FRAMEBUFFER,me,se,ve,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function _n(w){let x=i.get(w),Y=w.isWebGLCubeRenderTarget===!0;if(x.__boundDepthTexture!==w.depthTexture){let he=w.depthTexture;if(x.__depthDisposeCallback&&x.__depthDisposeCallback(),he){let ae=()=>{delete x.__boundDepthTexture,delete x.__depthDisposeCallback,he.removeEventListener("dispose",ae)};he.addEventListener("dispose",ae),x.__depthDisposeCallback=ae}x.__boundDepthTexture=he}if(w.depthTexture&&!x.__autoAllocateDepthBuffer)if(Y)for(let he=0;he<6;he++)xt(x.__webglFramebuffer[he],w,he);else w.texture.mipmaps.length>0?xt(x.__webglFramebuffer[0],w,0):xt(x.__webglFramebuffer,w,0);else if(Y){x.__webglDepthbuffer=[];for(let he=0;he<6;he++)if(t.bindFramebuffer(n.FRAMEBUFFER,x.__webglFramebuffer[he]),x.__webglDepthbuffer[he]===void 0)x.__webglDepthbuffer[he]=n.createRenderbuffer(),Tn(x.__webglDepthbuffer[he],w,!1);else{let ae=w.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,ye=x.__webglDepthbuffer[he];n.bindRenderbuffer(n.RENDERBUFFER,ye),n.framebufferRenderbuffer(n.FRAMEBUFFER,ae,n.RENDERBUFFER,ye)}}else if(w.texture.mipmaps.length>0?t.bindFramebuffer(n.FRAMEBUFFER,x.__webglFramebuffer[0]):t.bindFramebuffer(n.FRAMEBUFFER,x.__webglFramebuffer),x.__webglDepthbuffer===void 0)x.__webglDepthbuffer=n.createRenderbuffer(),Tn(x.__webglDepthbuffer,w,!1);else{let ae=w.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,ye=x.__webglDepthbuffer;n.bindRenderbuffer(n.RENDERBUFFER,ye),n.framebufferRenderbuffer(n.FRAMEBUFFER,ae,n.RENDERBUFFER,ye)}t.bindFramebuffer(n.FRAMEBUFFER,null)}function jt(w,x,Y){let he=i.get(w);x!==void 0&&Lt(he.__webglFramebuffer,w,w.texture,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,0),Y!==void 0&&_n(w)}function un(w){let x=w.texture,Y=i.get(w),he=i.get(x);w.addEventListener("dispose",k),B(w);let ae=w.textures,ye=w.isWebGLCubeRenderTarget===!0,ve=ae.length>1;if(ve||(he.__webglTexture===void 0&&(he.__webglTexture=n.createTexture()),he.__version=x.version,o.memory.textures++),ye){Y.__webglFramebuffer=[];for(let ne=0;ne<6;ne++)if(x.mipmaps.length>0){Y.__webglFramebuffer[ne]=[];for(let se=0;se<x.mipmaps.length;se++)Y.__webglFramebuffer[ne][se]=n.createFramebuffer()}else Y.__webglFramebuffer[ne]=n.createFramebuffer()}else{if(x.mipmaps.length>0){Y.__webglFramebuffer=[];for(let ne=0;ne<x.mipmaps.length;ne++)Y.__webglFramebuffer[ne]=n.createFramebuffer()}else Y.__webglFramebuffer=n.createFramebuffer();if(ve)for(let ne=0,se=ae.length;ne<se;ne++){let me=i.get(ae[ne]);me.__webglTexture===void 0&&(me.__webglTexture=n.createTexture(),o.memory.textures++)}if(w.samples>0&&Ee(w)===!1){Y.__webglMultisampledFramebuffer=n.createFramebuffer(),Y.__webglColorRenderbuffer=[],t.bindFramebuffer(n.FRAMEBUFFER,Y.__webglMultisampledFramebuffer);for(let ne=0;ne<ae.length;ne++){let se=ae[ne];Y.__webglColorRenderbuffer[ne]=n.createRenderbuffer(),n.bindRenderbuffer(n.RENDERBUFFER,Y.__webglColorRenderbuffer[ne]);let me=r.convert(se.format,se.colorSpace),F=r.convert(se.type),oe=T(se.internalFormat,me,F,se.normalized,se.colorSpace,w.isXRRenderTarget===!0),ie=rt(w);n.renderbufferStorageMultisample(n.RENDERBUFFER,ie,oe,w.width,w.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+ne,n.RENDERBUFFER,Y.__webglColorRenderbuffer[ne])}n.bindRenderbuffer(n.RENDERBUFFER,null),w.depthBuffer&&(Y.__webglDepthRenderbuffer=n.createRenderbuffer(),Tn(Y.__webglDepthRenderbuffer,w,!0)),t.bindFramebuffer(n.FRAMEBUFFER,null)}}if(ye){t.bindTexture(n.TEXTURE_CUBE_MAP,he.__webglTexture),ut(n.TEXTURE_CUBE_MAP,x);for(let ne=0;ne<6;ne++)if(x.mipmaps.length>0)for(let se=0;se<x.mipmaps.length;se++)Lt(Y.__webglFramebuffer[ne][se],w,x,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+ne,se);else Lt(Y.__webglFramebuffer[ne],w,x,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+ne,0);C(x)?E(n.TEXTURE_CUBE_MAP):x.mipmaps.length>0&&n.texParameteri(n.TEXTURE_CUBE_MAP,n.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}else if(ve){for(let ne=0,se=ae.length;ne<se;ne++){let me=ae[ne],F=i.get(me),oe=n.TEXTURE_2D;(w.isWebGL3DRenderTarget||w.isWebGLArrayRenderTarget)&&(oe=w.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(oe,F.__webglTexture),ut(oe,me),Lt(Y.__webglFramebuffer,w,me,n.COLOR_ATTACHMENT0+ne,oe,0),C(me)&&E(oe)}t.unbindTexture()}else{let ne=n.TEXTURE_2D;if((w.isWebGL3DRenderTarget||w.isWebGLArrayRenderTarget)&&(ne=w.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(ne,he.__webglTexture),ut(ne,x),x.mipmaps.length>0)for(let se=0;se<x.mipmaps.length;se++)Lt(Y.__webglFramebuffer[se],w,x,n.COLOR_ATTACHMENT0,ne,se);else Lt(Y.__webglFramebuffer,w,x,n.COLOR_ATTACHMENT0,ne,0);C(x)?E(ne):x.mipmaps.length>0&&n.texParameteri(ne,n.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}w.depthBuffer&&_n(w)}function U(w){let x=w.textures;for(let Y=0,he=x.length;Y<he;Y++){let ae=x[Y];if(C(ae)&&ae.mipmapsAutoUpdate===!0){let ye=I(w),ve=i.get(ae).__webglTexture;t.bindTexture(ye,ve),E(ye),t.unbindTexture()}}}let Ie=[];function Ke(w){if(w.samples>0){if(Ee(w)===!1){let x=w.textures,Y=w.width,he=w.height,ae=n.COLOR_BUFFER_BIT,ye=w.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,ve=i.get(w),ne=x.length>1;if(ne)for(let me=0;me<x.length;me++)t.bindFramebuffer(n.FRAMEBUFFER,ve.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+me,n.RENDERBUFFER,null),t.bindFramebuffer(n.FRAMEBUFFER,ve.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+me,n.TEXTURE_2D,null,0);t.bindFramebuffer(n.READ_FRAMEBUFFER,ve.__webglMultisampledFramebuffer),w.texture.mipmaps.length>0?t.bindFramebuffer(n.DRAW_FRAMEBUFFER,ve.__webglFramebuffer[0]):t.bindFramebuffer(n.DRAW_FRAMEBUFFER,ve.__webglFramebuffer);for(let me=0;me<x.length;me++){if(w.resolveDepthBuffer&&(w.depthBuffer&&(ae|=n.DEPTH_BUFFER_BIT),w.stencilBuffer&&w.resolveStencilBuffer&&(ae|=n.STENCIL_BUFFER_BIT)),ne){n.framebufferRenderbuffer(n.READ_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.RENDERBUFFER,ve.__webglColorRenderbuffer[me]);let F=i.get(x[me]).__webglTexture;n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,F,0)}n.blitFramebuffer(0,0,Y,he,0,0,Y,he,ae,n.NEAREST),c===!0&&(Ie.length=0,Ie.push(n.COLOR_ATTACHMENT0+me),w.depthBuffer&&w.storeMultisampledDepthBuffer===!1&&Ie.push(ye),n.invalidateFramebuffer(n.READ_FRAMEBUFFER,Ie))}if(t.bindFramebuffer(n.READ_FRAMEBUFFER,null),t.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),ne)for(let me=0;me<x.length;me++){t.bindFramebuffer(n.FRAMEBUFFER,ve.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+me,n.RENDERBUFFER,ve.__webglColorRenderbuffer[me]);let F=i.get(x[me]).__webglTexture;t.bindFramebuffer(n.FRAMEBUFFER,ve.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+me,n.TEXTURE_2D,F,0)}t.bindFramebuffer(n.DRAW_FRAMEBUFFER,ve.__webglMultisampledFramebuffer)}else if(w.depthBuffer&&w.storeMultisampledDepthBuffer===!1&&c){let x=w.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;n.invalidateFramebuffer(n.DRAW_FRAMEBUFFER,[x])}}}function rt(w){return Math.min(s.maxSamples,w.samples)}function Ee(w){let x=i.get(w);return w.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&x.__useRenderToTexture!==!1}function Ut(w){let x=o.render.frame;h.get(w)!==x&&(h.set(w,x),w.update())}function Ve(w,x){let Y=w.colorSpace,he=w.format,ae=w.type;return w.isCompressedTexture===!0||w.isVideoTexture===!0||Y!==Ar&&Y!==Ds&&(gt.getTransfer(Y)===wt?(he!==Wi||ae!==pi)&&Ze("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Qe("WebGLTextures: Unsupported texture color space:",Y)),x}function Ye(w){return typeof HTMLImageElement<"u"&&w instanceof HTMLImageElement?(l.width=w.naturalWidth||w.width,l.height=w.naturalHeight||w.height):typeof VideoFrame<"u"&&w instanceof VideoFrame?(l.width=w.displayWidth,l.height=w.displayHeight):(l.width=w.width,l.height=w.height),l}this.allocateTextureUnit=de,this.resetTextureUnits=ee,this.getTextureUnits=re,this.setTextureUnits=fe,this.setTexture2D=ge,this.setTexture2DArray=xe,this.setTexture3D=Re,this.setTextureCube=Me,this.rebindTextures=jt,this.setupRenderTarget=un,this.updateRenderTargetMipmap=U,this.updateMultisampleRenderTarget=Ke,this.setupDepthRenderbuffer=_n,this.setupFrameBufferTexture=Lt,this.useMultisampledRTT=Ee,this.dispose=W}function UT(n,e){function t(i,s=Ds){let r,o=gt.getTransfer(s);if(i===pi)return n.UNSIGNED_BYTE;if(i===su)return n.UNSIGNED_SHORT_4_4_4_4;if(i===ru)return n.UNSIGNED_SHORT_5_5_5_1;if(i===cf)return n.UNSIGNED_INT_5_9_9_9_REV;if(i===uf)return n.UNSIGNED_INT_10F_11F_11F_REV;if(i===af)return n.BYTE;if(i===lf)return n.SHORT;if(i===Po)return n.UNSIGNED_SHORT;if(i===iu)return n.INT;if(i===zi)return n.UNSIGNED_INT;if(i===mi)return n.FLOAT;if(i===Hi)return n.HALF_FLOAT;if(i===hf)return n.ALPHA;if(i===df)return n.RGB;if(i===Wi)return n.RGBA;if(i===Cs)return n.DEPTH_COMPONENT;if(i===Ls)return n.DEPTH_STENCIL;if(i===Wa)return n.RED;if(i===ou)return n.RED_INTEGER;if(i===cr)return n.RG;if(i===au)return n.RG_INTEGER;if(i===lu)return n.RGBA_INTEGER;if(i===Xa||i===Ya||i===Za||i===Ka)if(o===wt)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(i===Xa)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(i===Ya)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(i===Za)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(i===Ka)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(i===Xa)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(i===Ya)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(i===Za)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(i===Ka)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(i===cu||i===uu||i===hu||i===du)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(i===cu)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(i===uu)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(i===hu)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(i===du)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(i===fu||i===pu||i===mu||i===gu||i===_u||i===$a||i===yu)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(i===fu||i===pu)return o===wt?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(i===mu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(i===gu)return r.COMPRESSED_R11_EAC;if(i===_u)return r.COMPRESSED_SIGNED_R11_EAC;if(i===$a)return r.COMPRESSED_RG11_EAC;if(i===yu)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(i===xu||i===vu||i===bu||i===Su||i===Mu||i===Eu||i===Au||i===Tu||i===wu||i===Ru||i===Cu||i===Iu||i===Nu||i===Pu)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(i===xu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(i===vu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(i===bu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(i===Su)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(i===Mu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(i===Eu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(i===Au)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(i===Tu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(i===wu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(i===Ru)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(i===Cu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(i===Iu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(i===Nu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(i===Pu)return o===wt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(i===Lu||i===Du||i===Fu)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(i===Lu)return o===wt?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(i===Du)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(i===Fu)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(i===Uu||i===Ou||i===qa||i===Bu)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(i===Uu)return r.COMPRESSED_RED_RGTC1_EXT;if(i===Ou)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(i===qa)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(i===Bu)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return i===Pr?n.UNSIGNED_INT_24_8:n[i]!==void 0?n[i]:null}return{convert:t}}var OT=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,BT=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Df=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let i=new La(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=i}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,i=new wi({vertexShader:OT,fragmentShader:BT,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new di(new Fa(20,20),i)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Ff=class extends Vi{constructor(e,t){super();let i=this,s=null,r=1,o=null,a="local-floor",c=1,l=null,h=null,u=null,d=null,f=null,g=null,v=typeof XRWebGLBinding<"u",p=new Df,m={},b=t.getContextAttributes(),C=null,E=null,I=[],T=[],y=new $e,A=null,B=null,D=new Zn;D.viewport=new Jt;let L=new Zn;L.viewport=new Jt;let k=[D,L],z=new Qc,P=null,W=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(te){let ge=I[te];return ge===void 0&&(ge=new Ao,I[te]=ge),ge.getTargetRaySpace()},this.getControllerGrip=function(te){let ge=I[te];return ge===void 0&&(ge=new Ao,I[te]=ge),ge.getGripSpace()},this.getHand=function(te){let ge=I[te];return ge===void 0&&(ge=new Ao,I[te]=ge),ge.getHandSpace()};function K(te){let ge=T.indexOf(te.inputSource);if(ge===-1)return;let xe=I[ge];xe!==void 0&&(xe.update(te.inputSource,te.frame,l||o),xe.dispatchEvent({type:te.type,data:te.inputSource}))}function V(){s.removeEventListener("select",K),s.removeEventListener("selectstart",K),s.removeEventListener("selectend",K),s.removeEventListener("squeeze",K),s.removeEventListener("squeezestart",K),s.removeEventListener("squeezeend",K),s.removeEventListener("end",V),s.removeEventListener("inputsourceschange",ue);for(let te=0;te<I.length;te++){let ge=T[te];ge!==null&&(T[te]=null,I[te].disconnect(ge))}P=null,W=null,p.reset();for(let te in m)delete m[te];if(e.setRenderTarget(C),f=null,d=null,u=null,s=null,E=null,de.stop(),i.isPresenting=!1,e.setPixelRatio(A),e.setSize(y.width,y.height,!1),B!==null){let te=B.camera;te.fov=B.fov,te.zoom=B.zoom,te.updateProjectionMatrix(),B=null}i.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(te){r=te,i.isPresenting===!0&&Ze("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(te){a=te,i.isPresenting===!0&&Ze("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return l||o},this.setReferenceSpace=function(te){l=te},this.getBaseLayer=function(){return d!==null?d:f},this.getBinding=function(){return u===null&&v&&(u=new XRWebGLBinding(s,t)),u},this.getFrame=function(){return g},this.getSession=function(){return s},this.setSession=async function(te){if(s=te,s!==null){if(C=e.getRenderTarget(),s.addEventListener("select",K),s.addEventListener("selectstart",K),s.addEventListener("selectend",K),s.addEventListener("squeeze",K),s.addEventListener("squeezestart",K),s.addEventListener("squeezeend",K),s.addEventListener("end",V),s.addEventListener("inputsourceschange",ue),b.xrCompatible!==!0&&await t.makeXRCompatible(),A=e.getPixelRatio(),e.getSize(y),v&&"createProjectionLayer"in XRWebGLBinding.prototype){let xe=null,Re=null,Me=null;b.depth&&(Me=b.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,xe=b.stencil?Ls:Cs,Re=b.stencil?Pr:zi);let We={colorFormat:t.RGBA8,depthFormat:Me,scaleFactor:r};u=this.getBinding(),d=u.createProjectionLayer(We),s.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),E=new hi(d.textureWidth,d.textureHeight,{format:Wi,type:pi,depthTexture:new Ns(d.textureWidth,d.textureHeight,Re,void 0,void 0,void 0,void 0,void 0,void 0,xe),stencilBuffer:b.stencil,colorSpace:e.outputColorSpace,samples:b.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let xe={antialias:b.antialias,alpha:!0,depth:b.depth,stencil:b.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,xe),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),E=new hi(f.framebufferWidth,f.framebufferHeight,{format:Wi,type:pi,colorSpace:e.outputColorSpace,stencilBuffer:b.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}E.isXRRenderTarget=!0,this.setFoveation(c),l=null,o=await s.requestReferenceSpace(a),de.setContext(s),de.start(),i.isPresenting=!0,i.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function ue(te){for(let ge=0;ge<te.removed.length;ge++){let xe=te.removed[ge],Re=T.indexOf(xe);Re>=0&&(T[Re]=null,I[Re].disconnect(xe))}for(let ge=0;ge<te.added.length;ge++){let xe=te.added[ge],Re=T.indexOf(xe);if(Re===-1){for(let We=0;We<I.length;We++)if(We>=T.length){T.push(xe),Re=We;break}else if(T[We]===null){T[We]=xe,Re=We;break}if(Re===-1)break}let Me=I[Re];Me&&Me.connect(xe)}}function j(te,ge){ge===null?te.matrixWorld.copy(te.matrix):te.matrixWorld.multiplyMatrices(ge.matrixWorld,te.matrix),te.matrixWorldInverse.copy(te.matrixWorld).invert()}this.updateCamera=function(te){if(s===null)return;let ge=te.near,xe=te.far;p.texture!==null&&(p.depthNear>0&&(ge=p.depthNear),p.depthFar>0&&(xe=p.depthFar)),z.near=L.near=D.near=ge,z.far=L.far=D.far=xe,(P!==z.near||W!==z.far)&&(s.updateRenderState({depthNear:z.near,depthFar:z.far}),P=z.near,W=z.far),z.layers.mask=te.layers.mask|6,D.layers.mask=z.layers.mask&-5,L.layers.mask=z.layers.mask&-3;let Re=te.parent,Me=z.cameras;j(z,Re);for(let We=0;We<Me.length;We++)j(Me[We],Re);z.projectionMatrix.copy(D.projectionMatrix),z.projectionMatrixInverse.copy(D.projectionMatrixInverse),B===null&&te.isPerspectiveCamera&&(B={camera:te,fov:te.fov,zoom:te.zoom}),ee(te,z,Re)};function ee(te,ge,xe){xe===null?te.matrix.copy(ge.matrixWorld):(te.matrix.copy(xe.matrixWorld),te.matrix.invert(),te.matrix.multiply(ge.matrixWorld)),te.matrix.decompose(te.position,te.quaternion,te.scale),te.updateMatrixWorld(!0),te.projectionMatrix.copy(ge.projectionMatrix),te.projectionMatrixInverse.copy(ge.projectionMatrixInverse),te.isPerspectiveCamera&&(te.fov=So*2*Math.atan(1/te.projectionMatrix.elements[5]),te.zoom=1)}this.getCamera=function(){return z},this.getFoveation=function(){if(!(d===null&&f===null))return c},this.setFoveation=function(te){c=te,d!==null&&(d.fixedFoveation=te),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=te)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(z)},this.getCameraTexture=function(te){return m[te]};let re=null;function fe(te,ge){if(h=ge.getViewerPose(l||o),g=ge,h!==null){let xe=h.views;f!==null&&(e.setRenderTargetFramebuffer(E,f.framebuffer),e.setRenderTarget(E));let Re=!1;xe.length!==z.cameras.length&&(z.cameras.length=0,Re=!0);for(let ze=0;ze<xe.length;ze++){let ut=xe[ze],at=null;if(f!==null)at=f.getViewport(ut);else{let Kt=u.getViewSubImage(d,ut);at=Kt.viewport,ze===0&&(e.setRenderTargetTextures(E,Kt.colorTexture,Kt.depthStencilTexture),e.setRenderTarget(E))}let nt=k[ze];nt===void 0&&(nt=new Zn,nt.layers.enable(ze),nt.viewport=new Jt,k[ze]=nt),nt.matrix.fromArray(ut.transform.matrix),nt.matrix.decompose(nt.position,nt.quaternion,nt.scale),nt.projectionMatrix.fromArray(ut.projectionMatrix),nt.projectionMatrixInverse.copy(nt.projectionMatrix).invert(),nt.viewport.set(at.x,at.y,at.width,at.height),ze===0&&(z.matrix.copy(nt.matrix),z.matrix.decompose(z.position,z.quaternion,z.scale)),Re===!0&&z.cameras.push(nt)}let Me=s.enabledFeatures;if(Me&&Me.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&v){u=i.getBinding();let ze=u.getDepthInformation(xe[0]);ze&&ze.isValid&&ze.texture&&p.init(ze,s.renderState)}if(Me&&Me.includes("camera-access")&&v){e.state.unbindTexture(),u=i.getBinding();for(let ze=0;ze<xe.length;ze++){let ut=xe[ze].camera;if(ut){let at=m[ut];at||(at=new La,m[ut]=at);let nt=u.getCameraImage(ut);at.sourceTexture=nt}}}}for(let xe=0;xe<I.length;xe++){let Re=T[xe],Me=I[xe];Re!==null&&Me!==void 0&&Me.update(Re,ge,l||o)}re&&re(te,ge),ge.detectedPlanes&&i.dispatchEvent({type:"planesdetected",data:ge}),g=null}let de=new m_;de.setAnimationLoop(fe),this.setAnimationLoop=function(te){re=te},this.dispose=function(){}}},kT=new Ft,A_=new tt;A_.set(-1,0,0,0,1,0,0,0,1);function GT(n,e){function t(p,m){p.matrixAutoUpdate===!0&&p.updateMatrix(),m.value.copy(p.matrix)}function i(p,m){m.color.getRGB(p.fogColor.value,Sf(n)),m.isFog?(p.fogNear.value=m.near,p.fogFar.value=m.far):m.isFogExp2&&(p.fogDensity.value=m.density)}function s(p,m,b,C,E){m.isNodeMaterial?m.uniformsNeedUpdate=!1:m.isMeshBasicMaterial?r(p,m):m.isMeshLambertMaterial?(r(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshToonMaterial?(r(p,m),u(p,m)):m.isMeshPhongMaterial?(r(p,m),h(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshStandardMaterial?(r(p,m),d(p,m),m.isMeshPhysicalMaterial&&f(p,m,E)):m.isMeshMatcapMaterial?(r(p,m),g(p,m)):m.isMeshDepthMaterial?r(p,m):m.isMeshDistanceMaterial?(r(p,m),v(p,m)):m.isMeshNormalMaterial?r(p,m):m.isLineBasicMaterial?(o(p,m),m.isLineDashedMaterial&&a(p,m)):m.isPointsMaterial?c(p,m,b,C):m.isSpriteMaterial?l(p,m):m.isShadowMaterial?(p.color.value.copy(m.color),p.opacity.value=m.opacity):m.isShaderMaterial&&(m.uniformsNeedUpdate=!1)}function r(p,m){p.opacity.value=m.opacity,m.color&&p.diffuse.value.copy(m.color),m.emissive&&p.emissive.value.copy(m.emissive).multiplyScalar(m.emissiveIntensity),m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.bumpMap&&(p.bumpMap.value=m.bumpMap,t(m.bumpMap,p.bumpMapTransform),p.bumpScale.value=m.bumpScale,m.side===$n&&(p.bumpScale.value*=-1)),m.normalMap&&(p.normalMap.value=m.normalMap,t(m.normalMap,p.normalMapTransform),p.normalScale.value.copy(m.normalScale),m.side===$n&&p.normalScale.value.negate()),m.displacementMap&&(p.displacementMap.value=m.displacementMap,t(m.displacementMap,p.displacementMapTransform),p.displacementScale.value=m.displacementScale,p.displacementBias.value=m.displacementBias),m.emissiveMap&&(p.emissiveMap.value=m.emissiveMap,t(m.emissiveMap,p.emissiveMapTransform)),m.specularMap&&(p.specularMap.value=m.specularMap,t(m.specularMap,p.specularMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest);let b=e.get(m),C=b.envMap,E=b.envMapRotation;C&&(p.envMap.value=C,p.envMapRotation.value.setFromMatrix4(kT.makeRotationFromEuler(E)).transpose(),C.isCubeTexture&&C.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(A_),p.reflectivity.value=m.reflectivity,p.ior.value=m.ior,p.refractionRatio.value=m.refractionRatio),m.lightMap&&(p.lightMap.value=m.lightMap,p.lightMapIntensity.value=m.lightMapIntensity,t(m.lightMap,p.lightMapTransform)),m.aoMap&&(p.aoMap.value=m.aoMap,p.aoMapIntensity.value=m.aoMapIntensity,t(m.aoMap,p.aoMapTransform))}function o(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform))}function a(p,m){p.dashSize.value=m.dashSize,p.totalSize.value=m.dashSize+m.gapSize,p.scale.value=m.scale}function c(p,m,b,C){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.size.value=m.size*b,p.scale.value=C*.5,m.map&&(p.map.value=m.map,t(m.map,p.uvTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function l(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.rotation.value=m.rotation,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function h(p,m){p.specular.value.copy(m.specular),p.shininess.value=Math.max(m.shininess,1e-4)}function u(p,m){m.gradientMap&&(p.gradientMap.value=m.gradientMap)}function d(p,m){p.metalness.value=m.metalness,m.metalnessMap&&(p.metalnessMap.value=m.metalnessMap,t(m.metalnessMap,p.metalnessMapTransform)),p.roughness.value=m.roughness,m.roughnessMap&&(p.roughnessMap.value=m.roughnessMap,t(m.roughnessMap,p.roughnessMapTransform)),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)}function f(p,m,b){p.ior.value=m.ior,m.diffuseRoughness>0&&(p.diffuseRoughness.value=m.diffuseRoughness,m.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=m.diffuseRoughnessMap,t(m.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),m.sheen>0&&(p.sheenColor.value.copy(m.sheenColor).multiplyScalar(m.sheen),p.sheenRoughness.value=m.sheenRoughness,m.sheenColorMap&&(p.sheenColorMap.value=m.sheenColorMap,t(m.sheenColorMap,p.sheenColorMapTransform)),m.sheenRoughnessMap&&(p.sheenRoughnessMap.value=m.sheenRoughnessMap,t(m.sheenRoughnessMap,p.sheenRoughnessMapTransform))),m.clearcoat>0&&(p.clearcoat.value=m.clearcoat,p.clearcoatRoughness.value=m.clearcoatRoughness,m.clearcoatMap&&(p.clearcoatMap.value=m.clearcoatMap,t(m.clearcoatMap,p.clearcoatMapTransform)),m.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=m.clearcoatRoughnessMap,t(m.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),m.clearcoatNormalMap&&(p.clearcoatNormalMap.value=m.clearcoatNormalMap,t(m.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(m.clearcoatNormalScale),m.side===$n&&p.clearcoatNormalScale.value.negate())),m.dispersion>0&&(p.dispersion.value=m.dispersion),m.retroreflectivity>0&&(p.retroreflectivity.value=m.retroreflectivity),m.iridescence>0&&(p.iridescence.value=m.iridescence,p.iridescenceIOR.value=m.iridescenceIOR,p.iridescenceThicknessMinimum.value=m.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=m.iridescenceThicknessMaximum,m.iridescenceMap&&(p.iridescenceMap.value=m.iridescenceMap,t(m.iridescenceMap,p.iridescenceMapTransform)),m.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=m.iridescenceThicknessMap,t(m.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),m.transmission>0&&(p.transmission.value=m.transmission,p.transmissionSamplerMap.value=b.texture,p.transmissionSamplerSize.value.set(b.width,b.height),m.transmissionMap&&(p.transmissionMap.value=m.transmissionMap,t(m.transmissionMap,p.transmissionMapTransform)),p.thickness.value=m.thickness,m.thicknessMap&&(p.thicknessMap.value=m.thicknessMap,t(m.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=m.attenuationDistance,p.attenuationColor.value.copy(m.attenuationColor)),m.anisotropy>0&&(p.anisotropyVector.value.set(m.anisotropy*Math.cos(m.anisotropyRotation),m.anisotropy*Math.sin(m.anisotropyRotation)),m.anisotropyMap&&(p.anisotropyMap.value=m.anisotropyMap,t(m.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=m.specularIntensity,p.specularColor.value.copy(m.specularColor),m.specularColorMap&&(p.specularColorMap.value=m.specularColorMap,t(m.specularColorMap,p.specularColorMapTransform)),m.specularIntensityMap&&(p.specularIntensityMap.value=m.specularIntensityMap,t(m.specularIntensityMap,p.specularIntensityMapTransform))}function g(p,m){m.matcap&&(p.matcap.value=m.matcap)}function v(p,m){let b=e.get(m).light;p.referencePosition.value.setFromMatrixPosition(b.matrixWorld),p.nearDistance.value=b.shadow.camera.near,p.farDistance.value=b.shadow.camera.far}return{refreshFogUniforms:i,refreshMaterialUniforms:s}}function VT(n,e,t,i){let s={},r={};function o(b,C){let E=C.program;i.uniformBlockBinding(b,E,s[b.id])}function a(b,C){let E=s[b.id];E===void 0&&(g(b),E=c(b),s[b.id]=E,b.addEventListener("dispose",p));let I=C.program;i.updateUBOMapping(b,I);let T=e.render.frame;r[b.id]!==T&&(l(b),r[b.id]=T)}function c(b){let C=n.createBuffer(),E=b.__size,I=b.usage;return n.bindBuffer(n.UNIFORM_BUFFER,C),n.bufferData(n.UNIFORM_BUFFER,E,I),n.bindBuffer(n.UNIFORM_BUFFER,null),C}function l(b){let C=s[b.id],E=b.uniforms,I=b.__cache;n.bindBuffer(n.UNIFORM_BUFFER,C);for(let T=0,y=E.length;T<y;T++){let A=E[T];if(Array.isArray(A))for(let B=0,D=A.length;B<D;B++)h(A[B],T,B,I);else h(A,T,0,I)}n.bindBuffer(n.UNIFORM_BUFFER,null)}function h(b,C,E,I){if(d(b,C,E,I)===!0){let T=b.__offset,y=b.value;if(Array.isArray(y)){let A=0;for(let B=0;B<y.length;B++){let D=y[B],L=v(D,!0);u(D,b.__data,A),A+=L.storage/Float32Array.BYTES_PER_ELEMENT}}else u(y,b.__data,0);n.bufferSubData(n.UNIFORM_BUFFER,T,b.__data)}}function u(b,C,E){typeof b=="number"||typeof b=="boolean"?C[E]=b:b.isMatrix3?(C[E]=b.elements[0],C[E+1]=b.elements[1],C[E+2]=b.elements[2],C[E+3]=0,C[E+4]=b.elements[3],C[E+5]=b.elements[4],C[E+6]=b.elements[5],C[E+7]=0,C[E+8]=b.elements[6],C[E+9]=b.elements[7],C[E+10]=b.elements[8],C[E+11]=0):ArrayBuffer.isView(b)?C.set(b.subarray(0,C.length-E),E):b.toArray(C,E)}function d(b,C,E,I){let T=b.value,y=C+"_"+E;if(Array.isArray(T)){I[y]===void 0&&(I[y]=[]);let A=I[y],B=!1;for(let D=0;D<T.length;D++)f(T[D],A,D)===!0&&(B=!0);return B}return f(T,I,y)}function f(b,C,E){if(C[E]===void 0)return typeof b=="number"||typeof b=="boolean"?C[E]=b:ArrayBuffer.isView(b)?C[E]=b.slice():C[E]=b.clone(),!0;{let I=C[E];if(typeof b=="number"||typeof b=="boolean"){if(I!==b)return C[E]=b,!0}else{if(ArrayBuffer.isView(b))return!0;if(I.equals(b)===!1)return I.copy(b),!0}}return!1}function g(b){let C=b.uniforms,E=0,I=16;for(let y=0,A=C.length;y<A;y++){let B=Array.isArray(C[y])?C[y]:[C[y]];for(let D=0,L=B.length;D<L;D++){let k=B[D],z=Array.isArray(k.value)?k.value:[k.value],P=Array.isArray(C[y])||Array.isArray(k.value),W=E;for(let V=0,ue=z.length;V<ue;V++){let j=z[V],ee=v(j,P),re=E%I,fe=re%ee.boundary,de=re+fe;E+=fe,de!==0&&I-de<ee.storage&&(E+=I-de),V===0&&(W=E),E+=ee.storage}let K=k.type==="int"?Int32Array:k.type==="uint"?Uint32Array:Float32Array;k.__data=new K((E-W)/Float32Array.BYTES_PER_ELEMENT),k.__offset=W}}let T=E%I;return T>0&&(E+=I-T),b.__size=E,b.__cache={},this}function v(b,C){let E={boundary:0,storage:0};return typeof b=="number"||typeof b=="boolean"?(E.boundary=4,E.storage=4):b.isVector2?(E.boundary=8,E.storage=8):b.isVector3||b.isColor?(E.boundary=16,E.storage=12):b.isVector4?(E.boundary=16,E.storage=16):b.isMatrix3?(E.boundary=16,E.storage=48):b.isMatrix4?(E.boundary=16,E.storage=64):b.isTexture?Ze("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(b)?(E.boundary=16,E.storage=b.byteLength):Ze("WebGLRenderer: Unsupported uniform value type.",b),C===!0&&(E.boundary=16,E.storage=Math.ceil(E.storage/16)*16),E}function p(b){let C=b.target;C.removeEventListener("dispose",p),n.deleteBuffer(s[C.id]),delete s[C.id],delete r[C.id]}function m(){for(let b in s)n.deleteBuffer(s[b]);s={},r={}}return{bind:o,update:a,dispose:m}}var zT=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),os=null;function HT(){return os===null&&(os=new Tr(zT,16,16,cr,Hi),os.name="DFG_LUT",os.minFilter=Fn,os.magFilter=Fn,os.wrapS=is,os.wrapT=is,os.generateMipmaps=!1,os.needsUpdate=!0),os}var zu=class{constructor(e={}){let{canvas:t=B0(),context:i=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:c=!0,preserveDrawingBuffer:l=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=pi}=e;this.isWebGLRenderer=!0;let g;if(i!==null){if(typeof WebGLRenderingContext<"u"&&i instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");g=i.getContextAttributes().alpha}else g=o;let v=f,p=new Set([lu,au,ou]),m=new Set([pi,zi,Po,Pr,su,ru]),b=new Uint32Array(4),C=new Int32Array(4),E={textures:[],min:[],max:[],resolution:[]},I=null,T=null,y=[],A=[],B=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=rs,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let D=this,L=!1,k=null,z=null,P=null,W=null;this._outputColorSpace=li;let K=0,V=0,ue=null,j=-1,ee=null,re=new Jt,fe=new Jt,de=null,te=new _t(0),ge=0,xe=t.width,Re=t.height,Me=1,We=null,st=null,ze=new Jt(0,0,xe,Re),ut=new Jt(0,0,xe,Re),at=!1,nt=new wr,Kt=new Dc,Gt=!1,cn=!1,Lt=new Ft,Tn=new H,xt=new Jt,_n={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},jt=!1;function un(){return ue===null?Me:1}let U=i;function Ie(M,O){return t.getContext(M,O)}let Ke,rt,Ee,Ut,Ve,Ye,w,x,Y,he,ae,ye,ve,ne,se,me,F,oe,ie,Ae,_e,Se,He;try{let M={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:c,preserveDrawingBuffer:l,powerPreference:h,failIfMajorPerformanceCaveat:u};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",Be,!1),t.addEventListener("webglcontextrestored",je,!1),t.addEventListener("webglcontextcreationerror",Ce,!1),U===null){let O="webgl2";if(U=Ie(O,M),U===null)throw Ie(O)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}Je()}catch(M){throw t.removeEventListener("webglcontextlost",Be,!1),t.removeEventListener("webglcontextrestored",je,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),Qe("WebGLRenderer: "+M.message),M}function Je(){Ke=new eA(U),Ke.init(),_e=new UT(U,Ke),rt=new HE(U,Ke,e,_e),Ee=new DT(U,Ke),rt.reversedDepthBuffer&&d&&Ee.buffers.depth.setReversed(!0),z=U.createFramebuffer(),P=U.createFramebuffer(),W=U.createFramebuffer(),Ut=new iA(U),Ve=new vT,Ye=new FT(U,Ke,Ee,Ve,rt,_e,Ut),w=new QE(D),x=new rS(U),Se=new VE(U,x),Y=new tA(U,x,Ut,Se),he=new rA(U,Y,x,Se,Ut),oe=new sA(U,rt,Ye),se=new WE(Ve),ae=new xT(D,w,Ke,rt,Se,se),ye=new GT(D,Ve),ve=new ST,ne=new RT(Ke),F=new GE(D,w,Ee,he,g,c),me=new LT(D,he,rt),He=new VT(U,Ut,rt,Ee),ie=new zE(U,Ke,Ut),Ae=new nA(U,Ke,Ut),Ut.programs=ae.programs,D.capabilities=rt,D.extensions=Ke,D.properties=Ve,D.renderLists=ve,D.shadowMap=me,D.state=Ee,D.info=Ut}v!==pi&&(B=new aA(v,t.width,t.height,a,s,r));let ce=new Ff(D,U);this.xr=ce,this.getContext=function(){return U},this.getContextAttributes=function(){return U.getContextAttributes()},this.forceContextLoss=function(){let M=Ke.get("WEBGL_lose_context");M&&M.loseContext()},this.forceContextRestore=function(){let M=Ke.get("WEBGL_lose_context");M&&M.restoreContext()},this.getPixelRatio=function(){return Me},this.setPixelRatio=function(M){M!==void 0&&(Me=M,this.setSize(xe,Re,!1))},this.getSize=function(M){return M.set(xe,Re)},this.setSize=function(M,O,Q=!0){if(ce.isPresenting){Ze("WebGLRenderer: Can't change size while VR device is presenting.");return}xe=M,Re=O,t.width=Math.floor(M*Me),t.height=Math.floor(O*Me),Q===!0&&(t.style.width=M+"px",t.style.height=O+"px"),B!==null&&B.setSize(t.width,t.height),this.setViewport(0,0,M,O)},this.getDrawingBufferSize=function(M){return M.set(xe*Me,Re*Me).floor()},this.setDrawingBufferSize=function(M,O,Q){xe=M,Re=O,Me=Q,t.width=Math.floor(M*Q),t.height=Math.floor(O*Q),this.setViewport(0,0,M,O)},this.setEffects=function(M){if(v===pi){Qe("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(M){for(let O=0;O<M.length;O++)if(M[O].isOutputPass===!0){Ze("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}B.setEffects(M||[])},this.getCurrentViewport=function(M){return M.copy(re)},this.getViewport=function(M){return M.copy(ze)},this.setViewport=function(M,O,Q,Z){M.isVector4?ze.set(M.x,M.y,M.z,M.w):ze.set(M,O,Q,Z),Ee.viewport(re.copy(ze).multiplyScalar(un()).round())},this.getScissor=function(M){return M.copy(ut)},this.setScissor=function(M,O,Q,Z){M.isVector4?ut.set(M.x,M.y,M.z,M.w):ut.set(M,O,Q,Z),Ee.scissor(fe.copy(ut).multiplyScalar(un()).round())},this.getScissorTest=function(){return at},this.setScissorTest=function(M){Ee.setScissorTest(at=M)},this.setOpaqueSort=function(M){We=M},this.setTransparentSort=function(M){st=M},this.getClearColor=function(M){return M.copy(F.getClearColor())},this.setClearColor=function(){F.setClearColor(...arguments)},this.getClearAlpha=function(){return F.getClearAlpha()},this.setClearAlpha=function(){F.setClearAlpha(...arguments)},this.clear=function(M=!0,O=!0,Q=!0){let Z=0;if(M){let $=!1;if(ue!==null){let Te=ue.texture.format;$=p.has(Te)}if($){let Te=ue.texture.type,Ne=m.has(Te),we=F.getClearColor(),Pe=F.getClearAlpha(),Ge=we.r,et=we.g,ht=we.b;Ne?(b[0]=Ge,b[1]=et,b[2]=ht,b[3]=Pe,U.clearBufferuiv(U.COLOR,0,b)):(C[0]=Ge,C[1]=et,C[2]=ht,C[3]=Pe,U.clearBufferiv(U.COLOR,0,C))}else Z|=U.COLOR_BUFFER_BIT}O&&(Z|=U.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),Q&&(Z|=U.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),Z!==0&&U.clear(Z)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(M){M.setRenderer(this),k=M},this.dispose=function(){t.removeEventListener("webglcontextlost",Be,!1),t.removeEventListener("webglcontextrestored",je,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),F.dispose(),ve.dispose(),ne.dispose(),Ye.dispose(),Ve.dispose(),w.dispose(),he.dispose(),Y.dispose(),Se.dispose(),He.dispose(),ae.dispose(),ce.dispose(),ce.removeEventListener("sessionstart",ml),ce.removeEventListener("sessionend",$i),us.stop()};function Be(M){M.preventDefault(),_f("WebGLRenderer: Context Lost."),L=!0}function je(){_f("WebGLRenderer: Context Restored."),L=!1;let M=Ut.autoReset,O=me.enabled,Q=me.autoUpdate,Z=me.needsUpdate,$=me.type;Je(),Ut.autoReset=M,me.enabled=O,me.autoUpdate=Q,me.needsUpdate=Z,me.type=$}function Ce(M){Qe("WebGLRenderer: A WebGL context could not be created. Reason: ",M.statusMessage)}function ot(M){let O=M.target;O.removeEventListener("dispose",ot),zt(O)}function zt(M){zn(M),Ve.remove(M)}function zn(M){let O=Ve.get(M).programs;O!==void 0&&(O.forEach(function(Q){ae.releaseProgram(Q)}),M.isShaderMaterial&&ae.releaseShaderCache(M))}this.renderBufferDirect=function(M,O,Q,Z,$,Te){O===null&&(O=_n);let Ne=$.isMesh&&$.matrixWorld.determinantAffine()<0,we=Jo(M,O,Q,Z,$);Ee.setMaterial(Z,Ne);let Pe=Q.index,Ge=1;if(Z.wireframe===!0){if(Pe=Y.getWireframeAttribute(Q),Pe===void 0)return;Ge=2}let et=Q.drawRange,ht=Q.attributes.position,ke=et.start*Ge,dt=(et.start+et.count)*Ge;Te!==null&&(ke=Math.max(ke,Te.start*Ge),dt=Math.min(dt,(Te.start+Te.count)*Ge)),Pe!==null?(ke=Math.max(ke,0),dt=Math.min(dt,Pe.count)):ht!=null&&(ke=Math.max(ke,0),dt=Math.min(dt,ht.count));let qt=dt-ke;if(qt<0||qt===1/0)return;Se.setup($,Z,we,Q,Pe);let Ct,It=ie;if(Pe!==null&&(Ct=x.get(Pe),It=Ae,It.setIndex(Ct)),$.isMesh)Z.wireframe===!0?(Ee.setLineWidth(Z.wireframeLinewidth*un()),It.setMode(U.LINES)):It.setMode(U.TRIANGLES);else if($.isLine){let yn=Z.linewidth;yn===void 0&&(yn=1),Ee.setLineWidth(yn*un()),$.isLineSegments?It.setMode(U.LINES):$.isLineLoop?It.setMode(U.LINE_LOOP):It.setMode(U.LINE_STRIP)}else $.isPoints?It.setMode(U.POINTS):$.isSprite&&It.setMode(U.TRIANGLES);if($.isBatchedMesh)if(Ke.get("WEBGL_multi_draw"))It.renderMultiDraw($._multiDrawStarts,$._multiDrawCounts,$._multiDrawCount);else{let yn=$._multiDrawStarts,Ue=$._multiDrawCounts,hn=$._multiDrawCount,mt=Pe?x.get(Pe).bytesPerElement:1,ds=Ve.get(Z).currentProgram.getUniforms();for(let dn=0;dn<hn;dn++)ds.setValue(U,"_gl_DrawID",dn),It.render(yn[dn]/mt,Ue[dn])}else if($.isInstancedMesh)It.renderInstances(ke,qt,$.count);else if(Q.isInstancedBufferGeometry){let yn=Q._maxInstanceCount!==void 0?Q._maxInstanceCount:1/0,Ue=Math.min(Q.instanceCount,yn);It.renderInstances(ke,qt,Ue)}else It.render(ke,qt)};function Ko(M,O,Q,Z){k!==null&&M.isNodeMaterial&&k.setObject(Z,M),Gt===!0&&se.setState(M,Q,!1),M.transparent===!0&&M.side===Ri&&M.forceSinglePass===!1?(M.side=$n,M.needsUpdate=!0,qi(M,O,Z),M.side=lr,M.needsUpdate=!0,qi(M,O,Z),M.side=Ri):qi(M,O,Z)}this.compile=function(M,O,Q=null){Q===null&&(Q=M),k!==null&&k.renderStart(M,O,Q),T=ne.get(Q),T.init(O),A.push(T),Q.traverseVisible(function($){$.isLight&&$.layers.test(O.layers)&&(T.pushLight($),$.castShadow&&T.pushShadow($))}),M!==Q&&M.traverseVisible(function($){$.isLight&&$.layers.test(O.layers)&&(T.pushLight($),$.castShadow&&T.pushShadow($))}),T.setupLights(),k!==null&&k.updateLights(T.state.lightsArray),cn=this.localClippingEnabled,Gt=se.init(this.clippingPlanes,cn),Gt===!0&&se.setGlobalState(this.clippingPlanes,O),k!==null&&me.render(T.state.shadowsArray,Q,O);let Z=new Set;return M.traverse(function($){if(!($.isMesh||$.isPoints||$.isLine||$.isSprite))return;let Te=$.material;if(Te)if(Array.isArray(Te))for(let Ne=0;Ne<Te.length;Ne++){let we=Te[Ne];Ko(we,Q,O,$),Z.add(we)}else Ko(Te,Q,O,$),Z.add(Te)}),T=A.pop(),k!==null&&k.renderEnd(),Z},this.compileAsync=function(M,O,Q=null){let Z=this.compile(M,O,Q);return new Promise($=>{function Te(){if(Z.forEach(function(Ne){let Pe=Ve.get(Ne).currentProgram;(Pe===void 0||Pe.isReady())&&Z.delete(Ne)}),Z.size===0){$(M);return}setTimeout(Te,10)}Ke.get("KHR_parallel_shader_compile")!==null?Te():setTimeout(Te,10)})};let Vr=null;function Th(M){Vr&&Vr(M)}function ml(){us.stop()}function $i(){us.start()}let us=new m_;us.setAnimationLoop(Th),typeof self<"u"&&us.setContext(self),this.setAnimationLoop=function(M){Vr=M,ce.setAnimationLoop(M),M===null?us.stop():us.start()},ce.addEventListener("sessionstart",ml),ce.addEventListener("sessionend",$i),this.render=function(M,O){if(O!==void 0&&O.isCamera!==!0){Qe("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(L===!0)return;k!==null&&k.renderStart(M,O);let Q=ce.enabled===!0&&ce.isPresenting===!0,Z=B!==null&&(ue===null||Q)&&B.begin(D,ue);if(M.matrixWorldAutoUpdate===!0&&M.updateMatrixWorld(),O.parent===null&&O.matrixWorldAutoUpdate===!0&&O.updateMatrixWorld(),ce.enabled===!0&&ce.isPresenting===!0&&(B===null||B.isCompositing()===!1)&&(ce.cameraAutoUpdate===!0&&ce.updateCamera(O),O=ce.getCamera()),M.isScene===!0&&M.onBeforeRender(D,M,O,ue),T=ne.get(M,A.length),T.init(O),T.state.textureUnits=Ye.getTextureUnits(),A.push(T),Lt.multiplyMatrices(O.projectionMatrix,O.matrixWorldInverse),O.isArrayCamera?Kt.setFromArrayCamera(O):nt.setFromProjectionMatrix(Lt,Ti,O.reversedDepth),cn=this.localClippingEnabled,Gt=se.init(this.clippingPlanes,cn),I=ve.get(M,y.length),I.init(),y.push(I),this.info.render.frame++,ce.enabled===!0&&ce.isPresenting===!0){let Ne=D.xr.getDepthSensingMesh();Ne!==null&&hs(Ne,O,-1/0,D.sortObjects)}hs(M,O,0,D.sortObjects),I.finish(),k!==null&&k.updateLights(T.state.lightsArray),D.sortObjects===!0&&I.sort(We,st),jt=ce.enabled===!1||ce.isPresenting===!1||ce.hasDepthSensing()===!1,jt&&F.addToRenderList(I,M),this.info.autoReset===!0&&this.info.reset(),Gt===!0&&se.beginShadows();let $=T.state.shadowsArray;if(me.render($,M,O),Gt===!0&&se.endShadows(),(Z&&B.hasRenderPass())===!1){let Ne=I.opaque,we=I.transmissive;if(T.setupLights(),O.isArrayCamera){let Pe=O.cameras;if(we.length>0)for(let Ge=0,et=Pe.length;Ge<et;Ge++){let ht=Pe[Ge];Ni(Ne,we,M,ht)}jt&&F.render(M);for(let Ge=0,et=Pe.length;Ge<et;Ge++){let ht=Pe[Ge];$o(I,M,ht,ht.viewport)}}else we.length>0&&Ni(Ne,we,M,O),jt&&F.render(M),$o(I,M,O)}ue!==null&&V===0&&(Ye.updateMultisampleRenderTarget(ue),Ye.updateRenderTargetMipmap(ue)),Z&&B.end(D),M.isScene===!0&&M.onAfterRender(D,M,O),Se.resetDefaultState(),j=-1,ee=null,A.pop(),A.length>0?(T=A[A.length-1],Ye.setTextureUnits(T.state.textureUnits),Gt===!0&&se.setGlobalState(D.clippingPlanes,T.state.camera)):T=null,y.pop(),y.length>0?I=y[y.length-1]:I=null,k!==null&&k.renderEnd()};function hs(M,O,Q,Z){if(M.visible===!1)return;if(M.layers.test(O.layers)){if(M.isGroup)Q=M.renderOrder;else if(M.isLOD)M.autoUpdate===!0&&M.update(O);else if(M.isLight)T.pushLight(M),M.castShadow&&T.pushShadow(M);else if(M.isSprite){let Ne=O.isArrayCamera?Kt:nt;if(!M.frustumCulled||M.intersectsFrustum(Ne)){Z&&xt.setFromMatrixPosition(M.matrixWorld).applyMatrix4(Lt);let we=he.update(M),Pe=M.material;Pe.visible&&I.push(M,we,Pe,Q,xt.z,null,O)}}else if(M.isMesh||M.isLine||M.isPoints){let Ne=O.isArrayCamera?Kt:nt;if(!M.frustumCulled||M.intersectsFrustum(Ne)){let we=he.update(M),Pe=M.material;if(Z&&(M.boundingSphere!==void 0?(M.boundingSphere===null&&M.computeBoundingSphere(),xt.copy(M.boundingSphere.center)):(we.boundingSphere===null&&we.computeBoundingSphere(),xt.copy(we.boundingSphere.center)),xt.applyMatrix4(M.matrixWorld).applyMatrix4(Lt)),Array.isArray(Pe)){let Ge=we.groups;for(let et=0,ht=Ge.length;et<ht;et++){let ke=Ge[et],dt=Pe[ke.materialIndex];dt&&dt.visible&&I.push(M,we,dt,Q,xt.z,ke,O)}}else Pe.visible&&I.push(M,we,Pe,Q,xt.z,null,O)}}}let Te=M.children;for(let Ne=0,we=Te.length;Ne<we;Ne++)hs(Te[Ne],O,Q,Z)}function $o(M,O,Q,Z){let{opaque:$,transmissive:Te,transparent:Ne}=M;T.setupLightsView(Q),Gt===!0&&se.setGlobalState(D.clippingPlanes,Q),Z&&Ee.viewport(re.copy(Z)),$.length>0&&Qt($,O,Q),Te.length>0&&Qt(Te,O,Q),Ne.length>0&&Qt(Ne,O,Q),Ee.buffers.depth.setTest(!0),Ee.buffers.depth.setMask(!0),Ee.buffers.color.setMask(!0),Ee.setPolygonOffset(!1)}function Ni(M,O,Q,Z){if((Q.isScene===!0?Q.overrideMaterial:null)!==null)return;if(T.state.transmissionRenderTarget[Z.id]===void 0){let ke=Ke.has("EXT_color_buffer_half_float")||Ke.has("EXT_color_buffer_float");T.state.transmissionRenderTarget[Z.id]=new hi(1,1,{generateMipmaps:!0,type:ke?Hi:pi,minFilter:Ps,samples:Math.max(4,rt.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:gt.workingColorSpace})}let Te=T.state.transmissionRenderTarget[Z.id],Ne=Z.viewport||re;Te.setSize(Ne.z*D.transmissionResolutionScale,Ne.w*D.transmissionResolutionScale);let we=D.getRenderTarget(),Pe=D.getActiveCubeFace(),Ge=D.getActiveMipmapLevel();D.setRenderTarget(Te),D.getClearColor(te),ge=D.getClearAlpha(),ge<1&&D.setClearColor(16777215,.5),D.clear(),jt&&F.render(Q);let et=D.toneMapping;D.toneMapping=rs;let ht=Z.viewport;if(Z.viewport!==void 0&&(Z.viewport=void 0),T.setupLightsView(Z),Gt===!0&&se.setGlobalState(D.clippingPlanes,Z),Qt(M,Q,Z),Ye.updateMultisampleRenderTarget(Te),Ye.updateRenderTargetMipmap(Te),Ke.has("WEBGL_multisampled_render_to_texture")===!1){let ke=!1;for(let dt=0,qt=O.length;dt<qt;dt++){let Ct=O[dt],{object:It,geometry:yn,material:Ue,group:hn}=Ct;if(Ue.side===Ri&&It.layers.test(Z.layers)){let mt=Ue.side;Ue.side=$n,Ue.needsUpdate=!0,on(It,Q,Z,yn,Ue,hn),Ue.side=mt,Ue.needsUpdate=!0,ke=!0}}ke===!0&&(Ye.updateMultisampleRenderTarget(Te),Ye.updateRenderTargetMipmap(Te))}D.setRenderTarget(we,Pe,Ge),D.setClearColor(te,ge),ht!==void 0&&(Z.viewport=ht),D.toneMapping=et}function Qt(M,O,Q){let Z=O.isScene===!0?O.overrideMaterial:null;for(let $=0,Te=M.length;$<Te;$++){let Ne=M[$],{object:we,geometry:Pe,group:Ge}=Ne,et=Ne.material;et.allowOverride===!0&&Z!==null&&(et=Z),we.layers.test(Q.layers)&&on(we,O,Q,Pe,et,Ge)}}function on(M,O,Q,Z,$,Te){k!==null&&$.isNodeMaterial&&k.setObject(M,$),M.onBeforeRender(D,O,Q,Z,$,Te),M.modelViewMatrix.multiplyMatrices(Q.matrixWorldInverse,M.matrixWorld),M.normalMatrix.getNormalMatrix(M.modelViewMatrix),$.onBeforeRender(D,O,Q,Z,M,Te),$.transparent===!0&&$.side===Ri&&$.forceSinglePass===!1?($.side=$n,$.needsUpdate=!0,D.renderBufferDirect(Q,O,Z,$,M,Te),$.side=lr,$.needsUpdate=!0,D.renderBufferDirect(Q,O,Z,$,M,Te),$.side=Ri):D.renderBufferDirect(Q,O,Z,$,M,Te),M.onAfterRender(D,O,Q,Z,$,Te)}function an(M){let O=0;for(let Q of M)Q.texture!==null&&O++;return O}function qi(M,O,Q){O.isScene!==!0&&(O=_n);let Z=Ve.get(M),$=T.state.lights,Te=T.state.shadowsArray,Ne=$.state.version,we=ae.getParameters(M,$.state,Te,O,Q,T.state.lightProbeGridArray),Pe=ae.getProgramCacheKey(we),Ge=Z.programs;Z.environment=M.isMeshStandardMaterial||M.isMeshLambertMaterial||M.isMeshPhongMaterial?O.environment:null,Z.fog=O.fog;let et=M.isMeshStandardMaterial||M.isMeshLambertMaterial&&!M.envMap||M.isMeshPhongMaterial&&!M.envMap;Z.envMap=w.get(M.envMap||Z.environment,et),Z.envMapRotation=Z.environment!==null&&M.envMap===null?O.environmentRotation:M.envMapRotation,Ge===void 0&&(M.addEventListener("dispose",ot),Ge=new Map,Z.programs=Ge,Z.programVariants=new Map);let ht=Ge.get(Pe);if(ht!==void 0){if(Z.currentProgram===ht&&Z.lightsStateVersion===Ne)return qo(M,we),ht}else we.uniforms=ae.getUniforms(M),k!==null&&M.isNodeMaterial&&k.build(M,Q,we),M.onBeforeCompile(we,D),ht=ae.acquireProgram(we,Pe),Ge.set(Pe,ht),Z.uniforms=we.uniforms;let ke=Z.uniforms;return(!M.isShaderMaterial&&!M.isRawShaderMaterial||M.clipping===!0)&&(ke.clippingPlanes=se.uniform),qo(M,we),Z.needsLights=ks(M),Z.lightsStateVersion=Ne,Z.needsLights&&(ke.ambientLightColor.value=$.state.ambient,ke.lightProbe.value=$.state.probe,ke.sunLights.value=$.state.sun,ke.sunLightShadows.value=$.state.sunShadow,ke.directionalLights.value=$.state.directional,ke.directionalLightShadows.value=$.state.directionalShadow,ke.spotLights.value=$.state.spot,ke.spotLightShadows.value=$.state.spotShadow,ke.rectAreaLights.value=$.state.rectArea,ke.ltc_1.value=$.state.rectAreaLTC1,ke.ltc_2.value=$.state.rectAreaLTC2,ke.pointLights.value=$.state.point,ke.pointLightShadows.value=$.state.pointShadow,ke.hemisphereLights.value=$.state.hemi,ke.sunShadowMatrix.value=$.state.sunShadowMatrix,ke.sunShadowCascade.value=$.state.sunShadowCascade,ke.directionalShadowMatrix.value=$.state.directionalShadowMatrix,ke.spotLightMatrix.value=$.state.spotLightMatrix,ke.spotLightMap.value=$.state.spotLightMap,ke.pointShadowMatrix.value=$.state.pointShadowMatrix),Z.numLightProbeGrids=an(T.state.lightProbeGridArray),Z.currentProgram=ht,Z.uniformsList=null,ht}function ni(M,O,Q,Z,$){let Te=Ve.get(M),Ne=Te.currentProgram.id+","+Z+","+$,we=Te.programVariants.get(Ne);return we===void 0?(we=qi(M,O,Q),Te.programVariants.set(Ne,we)):(Te.currentProgram=we,Te.uniformsList=null,Te.outputColorSpace=Z,Te.toneMapping=$),we}function Bs(M){if(M.uniformsList===null){let O=M.currentProgram.getUniforms();M.uniformsList=Do.seqWithValue(O.seq,M.uniforms)}return M.uniformsList}function qo(M,O){let Q=Ve.get(M);Q.outputColorSpace=O.outputColorSpace,Q.batching=O.batching,Q.batchingColor=O.batchingColor,Q.instancing=O.instancing,Q.instancingColor=O.instancingColor,Q.instancingMorph=O.instancingMorph,Q.skinning=O.skinning,Q.morphTargets=O.morphTargets,Q.morphNormals=O.morphNormals,Q.morphColors=O.morphColors,Q.morphTargetsCount=O.morphTargetsCount,Q.numClippingPlanes=O.numClippingPlanes,Q.numIntersection=O.numClipIntersection,Q.vertexAlphas=O.vertexAlphas,Q.vertexTangents=O.vertexTangents,Q.toneMapping=O.toneMapping}function Jo(M,O,Q,Z,$){O.isScene!==!0&&(O=_n),Ye.resetTextureUnits();let Te=O.fog,Ne=Z.isMeshStandardMaterial||Z.isMeshLambertMaterial||Z.isMeshPhongMaterial?O.environment:null,we=ue===null?D.outputColorSpace:ue.isXRRenderTarget===!0?ue.texture.colorSpace:gt.workingColorSpace,Pe=Z.isMeshStandardMaterial||Z.isMeshLambertMaterial&&!Z.envMap||Z.isMeshPhongMaterial&&!Z.envMap,Ge=w.get(Z.envMap||Ne,Pe),et=Z.vertexColors===!0&&!!Q.attributes.color&&Q.attributes.color.itemSize===4,ht=!!Q.attributes.tangent&&(!!Z.normalMap||Z.anisotropy>0),ke=!!Q.morphAttributes.position,dt=!!Q.morphAttributes.normal,qt=!!Q.morphAttributes.color,Ct=rs;Z.toneMapped&&(ue===null||ue.isXRRenderTarget===!0)&&(Ct=D.toneMapping);let It=Q.morphAttributes.position||Q.morphAttributes.normal||Q.morphAttributes.color,yn=It!==void 0?It.length:0,Ue=Ve.get(Z),hn=T.state.lights;if(Gt===!0&&(cn===!0||M!==ee)){let Nt=M===ee&&Z.id===j;se.setState(Z,M,Nt)}let mt=!1,ds=!1;Z.version===Ue.__version?Ue.needsLights&&Ue.lightsStateVersion!==hn.state.version||$.isBatchedMesh&&Ue.batching===!1||!$.isBatchedMesh&&Ue.batching===!0||$.isBatchedMesh&&Ue.batchingColor===!0&&$._colorsTexture===null||$.isBatchedMesh&&Ue.batchingColor===!1&&$._colorsTexture!==null||$.isInstancedMesh&&Ue.instancing===!1||!$.isInstancedMesh&&Ue.instancing===!0||$.isSkinnedMesh&&Ue.skinning===!1||!$.isSkinnedMesh&&Ue.skinning===!0||$.isInstancedMesh&&Ue.instancingColor===!0&&$.instanceColor===null||$.isInstancedMesh&&Ue.instancingColor===!1&&$.instanceColor!==null||$.isInstancedMesh&&Ue.instancingMorph===!0&&$.morphTexture===null||$.isInstancedMesh&&Ue.instancingMorph===!1&&$.morphTexture!==null||Ue.envMap!==Ge||Z.fog===!0&&Ue.fog!==Te||Ue.numClippingPlanes!==void 0&&(Ue.numClippingPlanes!==se.numPlanes||Ue.numIntersection!==se.numIntersection)||Ue.vertexAlphas!==et||Ue.vertexTangents!==ht||Ue.morphTargets!==ke||Ue.morphNormals!==dt||Ue.morphColors!==qt||Ue.morphTargetsCount!==yn||Ue.numLightProbeGrids!==an(T.state.lightProbeGridArray)?mt=!0:(Ue.outputColorSpace!==we||Ue.toneMapping!==Ct)&&(ds=!0):(mt=!0,Ue.__version=Z.version);let dn=Ue.currentProgram;(mt===!0||ds===!0)&&(dn=ds===!0?ni(Z,O,$,we,Ct):qi(Z,O,$),k&&Z.isNodeMaterial&&k.onUpdateProgram(Z,dn,Ue));let Wr=!1,Ji=!1,fs=!1,lt=dn.getUniforms(),en=Ue.uniforms;if(Ee.useProgram(dn.program)&&(Wr=!0,Ji=!0,fs=!0),Z.id!==j&&(j=Z.id,Ji=!0),Wr||ee!==M){Ee.buffers.depth.getReversed()&&M.reversedDepth!==!0&&(M._reversedDepth=!0,M.updateProjectionMatrix()),lt.setValue(U,"projectionMatrix",M.projectionMatrix),lt.setValue(U,"viewMatrix",M.matrixWorldInverse);let fn=lt.map.cameraPosition;fn!==void 0&&fn.setValue(U,Tn.setFromMatrixPosition(M.matrixWorld)),rt.logarithmicDepthBuffer&&lt.setValue(U,"logDepthBufFC",2/(Math.log(M.far+1)/Math.LN2)),(Z.isMeshPhongMaterial||Z.isMeshToonMaterial||Z.isMeshLambertMaterial||Z.isMeshBasicMaterial||Z.isMeshStandardMaterial||Z.isShaderMaterial)&&lt.setValue(U,"isOrthographic",M.isOrthographicCamera===!0),ee!==M&&(ee=M,Ji=!0,fs=!0)}if(Ue.needsLights&&(hn.state.sunShadowMap.length>0&&lt.setValue(U,"sunShadowMap",hn.state.sunShadowMap,Ye),hn.state.directionalShadowMap.length>0&&lt.setValue(U,"directionalShadowMap",hn.state.directionalShadowMap,Ye),hn.state.spotShadowMap.length>0&&lt.setValue(U,"spotShadowMap",hn.state.spotShadowMap,Ye),hn.state.pointShadowMap.length>0&&lt.setValue(U,"pointShadowMap",hn.state.pointShadowMap,Ye)),$.isSkinnedMesh){lt.setOptional(U,$,"bindMatrix"),lt.setOptional(U,$,"bindMatrixInverse");let Nt=$.skeleton;Nt&&(Nt.boneTexture===null&&Nt.computeBoneTexture(),lt.setValue(U,"boneTexture",Nt.boneTexture,Ye))}$.isBatchedMesh&&(lt.setOptional(U,$,"batchingTexture"),lt.setValue(U,"batchingTexture",$._matricesTexture,Ye),lt.setOptional(U,$,"batchingIdTexture"),lt.setValue(U,"batchingIdTexture",$._indirectTexture,Ye),lt.setOptional(U,$,"batchingColorTexture"),$._colorsTexture!==null&&lt.setValue(U,"batchingColorTexture",$._colorsTexture,Ye));let Hn=Q.morphAttributes;if((Hn.position!==void 0||Hn.normal!==void 0||Hn.color!==void 0)&&oe.update($,Q,dn),(Ji||Ue.receiveShadow!==$.receiveShadow)&&(Ue.receiveShadow=$.receiveShadow,lt.setValue(U,"receiveShadow",$.receiveShadow)),(Z.isMeshStandardMaterial||Z.isMeshLambertMaterial||Z.isMeshPhongMaterial)&&Z.envMap===null&&O.environment!==null&&(en.envMapIntensity.value=O.environmentIntensity),en.dfgLUT!==void 0&&(en.dfgLUT.value=HT()),Ji){if(lt.setValue(U,"toneMappingExposure",D.toneMappingExposure),Ue.needsLights&&zr(en,fs),Te&&Z.fog===!0&&ye.refreshFogUniforms(en,Te),ye.refreshMaterialUniforms(en,Z,Me,Re,T.state.transmissionRenderTarget[M.id]),Ue.needsLights&&Ue.numLightProbeGrids>0){let Nt=E,fn=0;for(let On of T.state.lightProbeGridArray)On.texture!==null&&(Nt.textures[fn]=On.texture,Nt.min[fn]=On.boundingBox.min,Nt.max[fn]=On.boundingBox.max,Nt.resolution[fn]=On.resolution,fn++);for(let On in Nt)Nt[On].length=fn;en.probesSH.value=Nt.textures,en.probesMin.value=Nt.min,en.probesMax.value=Nt.max,en.probesResolution.value=Nt.resolution}Do.upload(U,Bs(Ue),en,Ye)}if(Z.isShaderMaterial&&Z.uniformsNeedUpdate===!0&&(Do.upload(U,Bs(Ue),en,Ye),Z.uniformsNeedUpdate=!1),Z.isSpriteMaterial&&lt.setValue(U,"center",$.center),lt.setValue(U,"modelViewMatrix",$.modelViewMatrix),lt.setValue(U,"normalMatrix",$.normalMatrix),lt.setValue(U,"modelMatrix",$.matrixWorld),Z.uniformsGroups!==void 0){let Nt=Z.uniformsGroups;for(let fn=0,On=Nt.length;fn<On;fn++){let gl=Nt[fn];He.update(gl,dn),He.bind(gl,dn)}}return dn}function zr(M,O){M.ambientLightColor.needsUpdate=O,M.lightProbe.needsUpdate=O,M.sunLights.needsUpdate=O,M.sunLightShadows.needsUpdate=O,M.directionalLights.needsUpdate=O,M.directionalLightShadows.needsUpdate=O,M.pointLights.needsUpdate=O,M.pointLightShadows.needsUpdate=O,M.spotLights.needsUpdate=O,M.spotLightShadows.needsUpdate=O,M.rectAreaLights.needsUpdate=O,M.hemisphereLights.needsUpdate=O}function ks(M){return M.isMeshLambertMaterial||M.isMeshToonMaterial||M.isMeshPhongMaterial||M.isMeshStandardMaterial||M.isShadowMaterial||M.isShaderMaterial&&M.lights===!0}this.getActiveCubeFace=function(){return K},this.getActiveMipmapLevel=function(){return V},this.getRenderTarget=function(){return ue},this.setRenderTargetTextures=function(M,O,Q){let Z=Ve.get(M);Z.__autoAllocateDepthBuffer=M.resolveDepthBuffer===!1,Z.__autoAllocateDepthBuffer===!1&&(Z.__useRenderToTexture=!1),Ve.get(M.texture).__webglTexture=O,Ve.get(M.depthTexture).__webglTexture=Z.__autoAllocateDepthBuffer?void 0:Q,Z.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(M,O){let Q=Ve.get(M);Q.__webglFramebuffer=O,Q.__useDefaultFramebuffer=O===void 0},this.setRenderTarget=function(M,O=0,Q=0){ue=M,K=O,V=Q;let Z=null,$=!1,Te=!1;if(M){let we=Ve.get(M);if(we.__useDefaultFramebuffer!==void 0){Ee.bindFramebuffer(U.FRAMEBUFFER,we.__webglFramebuffer),re.copy(M.viewport),fe.copy(M.scissor),de=M.scissorTest,Ee.viewport(re),Ee.scissor(fe),Ee.setScissorTest(de),j=-1;return}else if(we.__webglFramebuffer===void 0)Ye.setupRenderTarget(M);else if(we.__hasExternalTextures)Ye.rebindTextures(M,Ve.get(M.texture).__webglTexture,Ve.get(M.depthTexture).__webglTexture);else if(M.depthBuffer){let et=M.depthTexture;if(we.__boundDepthTexture!==et){if(et!==null&&Ve.has(et)&&(M.width!==et.image.width||M.height!==et.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Ye.setupDepthRenderbuffer(M)}}let Pe=M.texture;(Pe.isData3DTexture||Pe.isDataArrayTexture||Pe.isCompressedArrayTexture)&&(Te=!0);let Ge=Ve.get(M).__webglFramebuffer;M.isWebGLCubeRenderTarget?(Array.isArray(Ge[O])?Z=Ge[O][Q]:Z=Ge[O],$=!0):M.samples>0&&Ye.useMultisampledRTT(M)===!1?Z=Ve.get(M).__webglMultisampledFramebuffer:Array.isArray(Ge)?Z=Ge[Q]:Z=Ge,re.copy(M.viewport),fe.copy(M.scissor),de=M.scissorTest}else re.copy(ze).multiplyScalar(Me).floor(),fe.copy(ut).multiplyScalar(Me).floor(),de=at;if(Q!==0&&(Z=z),Ee.bindFramebuffer(U.FRAMEBUFFER,Z)&&Ee.drawBuffers(M,Z),Ee.viewport(re),Ee.scissor(fe),Ee.setScissorTest(de),$){let we=Ve.get(M.texture);U.framebufferTexture2D(U.FRAMEBUFFER,U.COLOR_ATTACHMENT0,U.TEXTURE_CUBE_MAP_POSITIVE_X+O,we.__webglTexture,Q)}else if(Te){let we=O;for(let Pe=0;Pe<M.textures.length;Pe++){let Ge=Ve.get(M.textures[Pe]);U.framebufferTextureLayer(U.FRAMEBUFFER,U.COLOR_ATTACHMENT0+Pe,Ge.__webglTexture,Q,we)}}else if(M!==null&&Q!==0){let we=Ve.get(M.texture);U.framebufferTexture2D(U.FRAMEBUFFER,U.COLOR_ATTACHMENT0,U.TEXTURE_2D,we.__webglTexture,Q)}j=-1};function Hr(M){let O=Ve.get(M);return(O.__readFormat!==M.format||O.__readType!==M.type)&&(O.__readFormat=M.format,O.__readType=M.type,O.__formatReadable=rt.textureFormatReadable(M.format),O.__typeReadable=rt.textureTypeReadable(M.type)),O}this.readRenderTargetPixels=function(M,O,Q,Z,$,Te,Ne,we=0){if(!(M&&M.isWebGLRenderTarget)){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Pe=Ve.get(M).__webglFramebuffer;if(M.isWebGLCubeRenderTarget&&Ne!==void 0&&(Pe=Pe[Ne],Array.isArray(Pe)&&(Pe=Pe[0])),Pe){Ee.bindFramebuffer(U.FRAMEBUFFER,Pe);try{let Ge=M.textures[we],et=Ge.format,ht=Ge.type;M.textures.length>1&&U.readBuffer(U.COLOR_ATTACHMENT0+we);let ke=Hr(Ge);if(ke.__formatReadable===!1){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(ke.__typeReadable===!1){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}O>=0&&O<=M.width-Z&&Q>=0&&Q<=M.height-$&&U.readPixels(O,Q,Z,$,_e.convert(et),_e.convert(ht),Te)}finally{let Ge=ue!==null?Ve.get(ue).__webglFramebuffer:null;Ee.bindFramebuffer(U.FRAMEBUFFER,Ge)}}},this.readRenderTargetPixelsAsync=async function(M,O,Q,Z,$,Te,Ne,we=0){if(!(M&&M.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Pe=Ve.get(M).__webglFramebuffer;if(M.isWebGLCubeRenderTarget&&Ne!==void 0&&(Pe=Pe[Ne],Array.isArray(Pe)&&(Pe=Pe[0])),Pe)if(O>=0&&O<=M.width-Z&&Q>=0&&Q<=M.height-$){Ee.bindFramebuffer(U.FRAMEBUFFER,Pe);let Ge=M.textures[we],et=Ge.format,ht=Ge.type;M.textures.length>1&&U.readBuffer(U.COLOR_ATTACHMENT0+we);let ke=Hr(Ge);if(ke.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(ke.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let dt=U.createBuffer();U.bindBuffer(U.PIXEL_PACK_BUFFER,dt),U.bufferData(U.PIXEL_PACK_BUFFER,Te.byteLength,U.STREAM_READ),U.readPixels(O,Q,Z,$,_e.convert(et),_e.convert(ht),0),U.bindBuffer(U.PIXEL_PACK_BUFFER,null);let qt=ue!==null?Ve.get(ue).__webglFramebuffer:null;Ee.bindFramebuffer(U.FRAMEBUFFER,qt);let Ct=U.fenceSync(U.SYNC_GPU_COMMANDS_COMPLETE,0);return U.flush(),await G0(U,Ct,4),U.bindBuffer(U.PIXEL_PACK_BUFFER,dt),U.getBufferSubData(U.PIXEL_PACK_BUFFER,0,Te),U.bindBuffer(U.PIXEL_PACK_BUFFER,null),U.deleteBuffer(dt),U.deleteSync(Ct),Te}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(M,O=null,Q=0){let Z=Math.pow(2,-Q),$=Math.floor(M.image.width*Z),Te=Math.floor(M.image.height*Z),Ne=O!==null?O.x:0,we=O!==null?O.y:0;Ye.setTexture2D(M,0),U.copyTexSubImage2D(U.TEXTURE_2D,Q,0,0,Ne,we,$,Te),Ee.unbindTexture()},this.copyTextureToTexture=function(M,O,Q=null,Z=null,$=0,Te=0){let Ne,we,Pe,Ge,et,ht,ke,dt,qt,Ct=M.isCompressedTexture?M.mipmaps[Te]:M.image;if(Q!==null)Ne=Q.max.x-Q.min.x,we=Q.max.y-Q.min.y,Pe=Q.isBox3?Q.max.z-Q.min.z:1,Ge=Q.min.x,et=Q.min.y,ht=Q.isBox3?Q.min.z:0;else{let lt=Math.pow(2,-$);Ne=Math.floor(Ct.width*lt),we=Math.floor(Ct.height*lt),M.isDataArrayTexture?Pe=Ct.depth:M.isData3DTexture?Pe=Math.floor(Ct.depth*lt):Pe=1,Ge=0,et=0,ht=0}Z!==null?(ke=Z.x,dt=Z.y,qt=Z.z):(ke=0,dt=0,qt=0);let It=_e.convert(O.format),yn=_e.convert(O.type),Ue;O.isData3DTexture?(Ye.setTexture3D(O,0),Ue=U.TEXTURE_3D):O.isDataArrayTexture||O.isCompressedArrayTexture?(Ye.setTexture2DArray(O,0),Ue=U.TEXTURE_2D_ARRAY):(Ye.setTexture2D(O,0),Ue=U.TEXTURE_2D),Ee.activeTexture(U.TEXTURE0),Ee.pixelStorei(U.UNPACK_FLIP_Y_WEBGL,O.flipY),Ee.pixelStorei(U.UNPACK_PREMULTIPLY_ALPHA_WEBGL,O.premultiplyAlpha),Ee.pixelStorei(U.UNPACK_ALIGNMENT,O.unpackAlignment);let hn=Ee.getParameter(U.UNPACK_ROW_LENGTH),mt=Ee.getParameter(U.UNPACK_IMAGE_HEIGHT),ds=Ee.getParameter(U.UNPACK_SKIP_PIXELS),dn=Ee.getParameter(U.UNPACK_SKIP_ROWS),Wr=Ee.getParameter(U.UNPACK_SKIP_IMAGES);Ee.pixelStorei(U.UNPACK_ROW_LENGTH,Ct.width),Ee.pixelStorei(U.UNPACK_IMAGE_HEIGHT,Ct.height),Ee.pixelStorei(U.UNPACK_SKIP_PIXELS,Ge),Ee.pixelStorei(U.UNPACK_SKIP_ROWS,et),Ee.pixelStorei(U.UNPACK_SKIP_IMAGES,ht);let Ji=M.isDataArrayTexture||M.isData3DTexture,fs=O.isDataArrayTexture||O.isData3DTexture;if(M.isDepthTexture){let lt=Ve.get(M),en=Ve.get(O),Hn=Ve.get(lt.__renderTarget),Nt=Ve.get(en.__renderTarget);Ee.bindFramebuffer(U.READ_FRAMEBUFFER,Hn.__webglFramebuffer),Ee.bindFramebuffer(U.DRAW_FRAMEBUFFER,Nt.__webglFramebuffer);for(let fn=0;fn<Pe;fn++)Ji&&(U.framebufferTextureLayer(U.READ_FRAMEBUFFER,U.COLOR_ATTACHMENT0,Ve.get(M).__webglTexture,$,ht+fn),U.framebufferTextureLayer(U.DRAW_FRAMEBUFFER,U.COLOR_ATTACHMENT0,Ve.get(O).__webglTexture,Te,qt+fn)),U.blitFramebuffer(Ge,et,Ge+Ne,et+we,ke,dt,ke+Ne,dt+we,U.DEPTH_BUFFER_BIT,U.NEAREST);Ee.bindFramebuffer(U.READ_FRAMEBUFFER,null),Ee.bindFramebuffer(U.DRAW_FRAMEBUFFER,null)}else if($!==0||M.isRenderTargetTexture||Ve.has(M)){let lt=Ve.get(M),en=Ve.get(O);Ee.bindFramebuffer(U.READ_FRAMEBUFFER,P),Ee.bindFramebuffer(U.DRAW_FRAMEBUFFER,W);for(let Hn=0;Hn<Pe;Hn++)Ji?U.framebufferTextureLayer(U.READ_FRAMEBUFFER,U.COLOR_ATTACHMENT0,lt.__webglTexture,$,ht+Hn):U.framebufferTexture2D(U.READ_FRAMEBUFFER,U.COLOR_ATTACHMENT0,U.TEXTURE_2D,lt.__webglTexture,$),fs?U.framebufferTextureLayer(U.DRAW_FRAMEBUFFER,U.COLOR_ATTACHMENT0,en.__webglTexture,Te,qt+Hn):U.framebufferTexture2D(U.DRAW_FRAMEBUFFER,U.COLOR_ATTACHMENT0,U.TEXTURE_2D,en.__webglTexture,Te),$!==0?U.blitFramebuffer(Ge,et,Ge+Ne,et+we,ke,dt,ke+Ne,dt+we,U.COLOR_BUFFER_BIT,U.NEAREST):fs?U.copyTexSubImage3D(Ue,Te,ke,dt,qt+Hn,Ge,et,Ne,we):U.copyTexSubImage2D(Ue,Te,ke,dt,Ge,et,Ne,we);Ee.bindFramebuffer(U.READ_FRAMEBUFFER,null),Ee.bindFramebuffer(U.DRAW_FRAMEBUFFER,null)}else fs?M.isDataTexture||M.isData3DTexture?U.texSubImage3D(Ue,Te,ke,dt,qt,Ne,we,Pe,It,yn,Ct.data):O.isCompressedArrayTexture?U.compressedTexSubImage3D(Ue,Te,ke,dt,qt,Ne,we,Pe,It,Ct.data):U.texSubImage3D(Ue,Te,ke,dt,qt,Ne,we,Pe,It,yn,Ct):M.isDataTexture?U.texSubImage2D(U.TEXTURE_2D,Te,ke,dt,Ne,we,It,yn,Ct.data):M.isCompressedTexture?U.compressedTexSubImage2D(U.TEXTURE_2D,Te,ke,dt,Ct.width,Ct.height,It,Ct.data):U.texSubImage2D(U.TEXTURE_2D,Te,ke,dt,Ne,we,It,yn,Ct);Ee.pixelStorei(U.UNPACK_ROW_LENGTH,hn),Ee.pixelStorei(U.UNPACK_IMAGE_HEIGHT,mt),Ee.pixelStorei(U.UNPACK_SKIP_PIXELS,ds),Ee.pixelStorei(U.UNPACK_SKIP_ROWS,dn),Ee.pixelStorei(U.UNPACK_SKIP_IMAGES,Wr),Te===0&&O.generateMipmaps===!0&&O.mipmapsAutoUpdate===!0&&U.generateMipmap(Ue),Ee.unbindTexture()},this.initRenderTarget=function(M){Ve.get(M).__webglFramebuffer===void 0&&Ye.setupRenderTarget(M)},this.initTexture=function(M){M.isCubeTexture?Ye.setTextureCube(M,0):M.isData3DTexture?Ye.setTexture3D(M,0):M.isDataArrayTexture||M.isCompressedArrayTexture?Ye.setTexture2DArray(M,0):Ye.setTexture2D(M,0),Ee.unbindTexture()},this.resetState=function(){K=0,V=0,ue=null,Ee.reset(),Se.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Ti}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=gt._getDrawingBufferColorSpace(e),t.unpackColorSpace=gt._getUnpackColorSpace()}};var il=[["read","Read","Touch the surface to read it",null,1,1],["spot","Spot","Touch a place on the surface",0,1,1],["line","Line","Touch both ends of a line",1,2,2],["area","Area","Touch the corners of an area, then Done",2,3,200],["distance","Distance","Touch two places",4,2,2],["note","Note","Touch the place of the note",5,1,1]],XT="http://www.w3.org/2000/svg",YT=.03;function nl(n,e){let t=document.createElementNS(XT,n);for(let[i,s]of Object.entries(e))t.setAttribute(i,s);return t}function Fs(n){return new H(n?.x??0,n?.y??0,n?.z??0)}function ZT(){return[...crypto.getRandomValues(new Uint8Array(9))].map(n=>n.toString(36).padStart(2,"0")).join("").slice(0,12)}var KT={0:"Spot",1:"Line",2:"Area",3:"Difference",4:"Distance",5:"Note"};function Uf(n){return KT[n]??"Object"}function Of(n,e,t){if(!e)return"–";if(e.problem!=="")return"not there";switch(n.kind){case 0:return Mi(e.record?.objectCelsius,t);case 1:case 2:return e.object?`max ${Mi(e.object.maxCelsius,t)}`:"not measured";case 3:return xs(e.differenceK,t);case 4:return`${(1e3*e.lengthM).toFixed(1)} mm`;default:return""}}var Yu=class{constructor(e,t,i,s){this.view=e;this.connection=t;this.looks=i;this.tell=s;this.done=X("button",{type:"button",class:"primary",onclick:()=>{this.finish()}},"Done"),this.back=X("button",{type:"button",onclick:()=>{this.pending.pop(),this.refresh()}},"Undo point"),this.hint=X("div",{class:"hint",role:"status",hidden:!0},this.hintText,this.back,X("button",{type:"button",onclick:()=>this.setTool("read")},"Cancel"),this.done),this.readout=X("div",{class:"readout",role:"status","aria-live":"polite",hidden:!0}),e.onFrame=()=>this.draw();let r=null;e.canvas.addEventListener("pointerdown",o=>{r=o.isPrimary?{x:o.clientX,y:o.clientY,id:o.pointerId}:null}),e.canvas.addEventListener("pointerup",o=>{r?.id===o.pointerId&&Math.hypot(o.clientX-r.x,o.clientY-r.y)<8&&this.touch(o.clientX,o.clientY),r=null}),e.canvas.addEventListener("pointermove",o=>{o.pointerType==="mouse"&&o.buttons===0&&this.hover(o.clientX,o.clientY)}),e.canvas.addEventListener("pointerleave",()=>{this.tool==="read"&&!this.sticky&&this.showPlace(null)})}view;connection;looks;tell;overlay=nl("svg",{class:"overlay","aria-hidden":"true"});labels=X("div",{class:"labels","aria-hidden":"true"});hint;readout;hintText=X("span",{});done;back;tool="read";pending=[];shapes=[];measured=new Map;place=null;marker=null;asking=!1;counter=0;selected="";onTool=()=>{};onSelect=()=>{};onMade=()=>{};sticky=!1;setTool(e){this.tool=e,this.pending=[],this.view.canvas.dataset.tool=e,this.onTool(e),this.refresh()}get current(){return this.tool}set(e){this.shapes=e.shapes,this.measured=new Map(e.measured.map(t=>[t.id,t])),this.view.invalidate()}select(e){this.selected=e,this.view.invalidate()}mark(e){this.marker=e,this.view.invalidate()}async pick(e,t){let i=this.view.rayAt(e,t),s=this.looks.value,r=s.interpret?sn(no,{emissivity:s.emissivity,reflectedCelsius:s.reflected_celsius,material:s.material}):sn(no),o=await this.connection.ask({case:"pick",value:{ray:{origin:{...i.origin},direction:{...i.direction}},parameters:r}});if(o?.result.case!=="record"||!o.result.value.hit)return null;let a=o.result.value,c=Fs(a.point).addScaledVector(i.direction,-YT);return{anchor:sn(xg,{origin:{x:c.x,y:c.y,z:c.z},direction:{...i.direction}}),record:a}}touchMiddle(){let e=this.view.canvas.getBoundingClientRect();this.touch(e.left+e.width/2,e.top+e.height/2)}async hover(e,t){if(this.asking||this.sticky||this.tool!=="read"||this.view.surface.groups===0)return;this.asking=!0;let i=await this.pick(e,t);this.sticky||this.showPlace(i?{point:Fs(i.record.point),record:i.record}:null),setTimeout(()=>{this.asking=!1},90)}async touch(e,t){let i=await this.pick(e,t);if(!i){this.sticky=!1,this.showPlace(null),this.tool!=="read"&&this.tell("There is no surface","Touch a place where the surface is drawn");return}let s={point:Fs(i.record.point),record:i.record};if(this.tool==="read"){this.sticky=!0,this.showPlace(s);return}this.pending.push({anchor:i.anchor,point:s.point});let[,,,,,r]=il.find(([o])=>o===this.tool);this.pending.length>=r?await this.finish():this.refresh()}async finish(){let[,e,,t,i]=il.find(([a])=>a===this.tool);if(t===null||this.pending.length<i)return;let s=this.shapes.filter(a=>a.kind===t).length+1,r=sn(pa,{id:ZT(),name:`${e} ${s}`,kind:t,anchors:this.pending.map(({anchor:a})=>a)}),o=this.looks.value;o.interpret&&(r.parameters=sn(no,{emissivity:o.emissivity,reflectedCelsius:o.reflected_celsius,...o.material===""?{}:{material:o.material}})),++this.counter,await this.put(r)&&(this.setTool("read"),this.onMade(r))}async put(e){let t=await this.connection.ask({case:"edit",value:{change:{case:"put",value:e}}});return t?.done!==!0&&this.tell("Not measured",t?.text??"the connection is gone"),t?.done===!0}async change(e){let t=await this.connection.ask({case:"edit",value:{change:e}});t?.done!==!0&&this.tell("Not changed",t?.text??"the connection is gone")}closeReadout(){this.sticky=!1,this.showPlace(null)}refresh(){let[,,e,,t]=il.find(([i])=>i===this.tool);Vt(this.hint,this.tool!=="read"),Pt(this.hintText,this.pending.length>0&&this.tool==="area"?`${this.pending.length} corners`:e),Vt(this.back,this.pending.length>0),this.done.disabled=this.pending.length<t,this.tool!=="read"&&this.closeReadout(),this.view.invalidate()}showPlace(e){this.place=e,Vt(this.readout,e!==null),e&&this.readout.replaceChildren(...Bf(e.record,this.looks.value.unit),this.sticky?X("button",{type:"button",class:"close","aria-label":"Close",onclick:()=>this.closeReadout()},"×"):""),this.view.invalidate()}draw(){let e=this.view.canvas.getBoundingClientRect(),t=l=>{let h=this.view.project(l);return h?{x:h.x-e.left,y:h.y-e.top}:null},i=[],s=[],r=(l,h)=>{let u=t(l);u&&i.push(nl("circle",{cx:String(u.x),cy:String(u.y),r:"9",class:`ring ${h}`}),nl("path",{d:`M${u.x-15} ${u.y}H${u.x-4}M${u.x+4} ${u.y}H${u.x+15}M${u.x} ${u.y-15}V${u.y-4}M${u.x} ${u.y+4}V${u.y+15}`,class:`cross ${h}`}))},o=(l,h,u)=>{let d=l.map(t);d.length<2||d.some(f=>f===null)||i.push(nl("path",{d:`M${d.map(f=>`${f.x.toFixed(1)} ${f.y.toFixed(1)}`).join("L")}${h?"Z":""}`,class:`stroke ${u}`}))},a=(l,h,u,d,f)=>{let g=t(l);if(!g||g.x<-40||g.y<-40||g.x>e.width+40||g.y>e.height+40)return;let v=X("button",{type:"button",class:`label${f===""?"":` alarm-${f}`}${d===this.selected?" selected":""}`,tabIndex:-1,onclick:()=>this.onSelect(d)},X("small",{},h),u===""?null:X("b",{},u));v.style.transform=`translate(${g.x+16}px, ${g.y-14}px)`,s.push(v)},{unit:c}=this.looks.value;for(let l of this.shapes){let h=this.measured.get(l.id),u=(h?.corners.length??0)>0?h.corners.map(Fs):l.anchors.map(({origin:g})=>Fs(g));if(u.length===0)continue;let d=`${l.id===this.selected?"selected":""} ${h?.alarm?`alarm-${h.alarm}`:""}`;l.kind===2?o(u,!0,d):l.kind===1&&h&&h.profile.length>1?o(h.profile.map(({point:g})=>Fs(g)),!1,d):u.length>1&&o(u,!1,d),u.length===1&&r(u[0],d);let f=h?.object?.hottest;if(f&&(l.kind===2||l.kind===1)){let g=t(Fs(f));g&&i.push(nl("path",{d:`M${g.x-7} ${g.y+5}h14l-7-13z`,class:"hot"}))}a(u[0],l.name,Of(l,h,c),l.id,h?.alarm??"")}if(this.pending.length>0){o(this.pending.map(({point:l})=>l),this.tool==="area"&&this.pending.length>2,"pending");for(let{point:l}of this.pending)r(l,"pending")}this.place&&r(this.place.point,"cursor"),this.marker&&r(this.marker,"cursor"),this.overlay.replaceChildren(...i),this.labels.replaceChildren(...s)}},T_=["not checked","bad","acceptable","good"];function Bf(n,e){let t=[],{objectCelsius:i,apparentCelsius:s}=n;i!==void 0&&s!==void 0&&Math.abs(i-s)>.004&&t.push(["apparent",Mi(s,e,2)]);let r=n.objectSigmaK??n.sigmaK;return r!==void 0&&t.push(["uncertainty",`± ${xs(r,e,2)}`]),n.distanceM!==void 0&&t.push(["distance",`${(100*n.distanceM).toFixed(0)} cm, ${T_[n.distanceClass]}`]),n.angleDeg!==void 0&&t.push(["angle",`${n.angleDeg.toFixed(0)}°, ${T_[n.angleClass]}`]),n.nucAgeS!==void 0&&t.push(["after NUC",`${n.nucAgeS.toFixed(0)} s`]),n.observations>0&&t.push(["good views",String(n.observations)]),n.disagreementK!==void 0&&t.push(["spread",xs(n.disagreementK,e,2)]),[X("p",{class:`value quality-${n.quality}`},Mi(i??s,e),X("span",{class:"quality"},n.quality==="never"?"not measured":n.quality)),X("dl",{},...t.map(([o,a])=>X("div",{},X("dt",{},o),X("dd",{},a)))),...n.reasons.map(o=>X("p",{class:"why"},o))]}var $T="uplot",qT="u-hz",JT="u-vt",jT="u-title",QT="u-wrap",ew="u-under",tw="u-over",nw="u-axis",Ur="u-off",iw="u-select",sw="u-cursor-x",rw="u-cursor-y",ow="u-cursor-pt",aw="u-legend",lw="u-live",cw="u-inline",uw="u-series",hw="u-marker",w_="u-label",dw="u-value",rl="width",ol="height";var R_="bottom",Uo="left",kf="right",np="#000",C_=np+"0",Gf="mousemove",I_="mousedown",Vf="mouseup",N_="mouseenter",P_="mouseleave",L_="dblclick",fw="resize",pw="scroll",D_="change",Ju="dppxchange",ip="--",Ho=typeof window<"u",Yf=Ho?document:null,Bo=Ho?window:null,mw=Ho?navigator:null,Mt,Zu;function Zf(){let n=devicePixelRatio;Mt!=n&&(Mt=n,Zu&&$f(D_,Zu,Zf),Zu=matchMedia(`(min-resolution: ${Mt-.001}dppx) and (max-resolution: ${Mt+.001}dppx)`),Or(D_,Zu,Zf),Bo.dispatchEvent(new CustomEvent(Ju)))}function gi(n,e){if(e!=null){let t=n.classList;!t.contains(e)&&t.add(e)}}function Kf(n,e){let t=n.classList;t.contains(e)&&t.remove(e)}function Zt(n,e,t){n.style[e]=t+"px"}function Xi(n,e,t,i){let s=Yf.createElement(n);return e!=null&&gi(s,e),t?.insertBefore(s,i),s}function Ci(n,e){return Xi("div",n,e)}var F_=new WeakMap;function ls(n,e,t,i,s){let r="translate("+e+"px,"+t+"px)",o=F_.get(n);r!=o&&(n.style.transform=r,F_.set(n,r),e<0||t<0||e>i||t>s?gi(n,Ur):Kf(n,Ur))}var U_=new WeakMap;function O_(n,e,t){let i=e+t,s=U_.get(n);i!=s&&(U_.set(n,i),n.style.background=e,n.style.borderColor=t)}var B_=new WeakMap;function k_(n,e,t,i){let s=e+""+t,r=B_.get(n);s!=r&&(B_.set(n,s),n.style.height=t+"px",n.style.width=e+"px",n.style.marginLeft=i?-e/2+"px":0,n.style.marginTop=i?-t/2+"px":0)}var sp={passive:!0},gw={...sp,capture:!0};function Or(n,e,t,i){e.addEventListener(n,t,i?gw:sp)}function $f(n,e,t,i){e.removeEventListener(n,t,sp)}Ho&&Zf();function Yi(n,e,t,i){let s;t=t||0,i=i||e.length-1;let r=i<=2147483647;for(;i-t>1;)s=r?t+i>>1:_i((t+i)/2),e[s]<n?t=s:i=s;return n-e[t]<=e[i]-n?t:i}function fy(n){return(t,i,s)=>{let r=-1,o=-1;for(let a=i;a<=s;a++)if(n(t[a])){r=a;break}for(let a=s;a>=i;a--)if(n(t[a])){o=a;break}return[r,o]}}var py=n=>n!=null,my=n=>n!=null&&n>0,eh=fy(py),_w=fy(my);function yw(n,e,t,i=0,s=!1){let r=s?_w:eh,o=s?my:py;[e,t]=r(n,e,t);let a=n[e],c=n[e];if(e>-1)if(i==1)a=n[e],c=n[t];else if(i==-1)a=n[t],c=n[e];else for(let l=e;l<=t;l++){let h=n[l];o(h)&&(h<a?a=h:h>c&&(c=h))}return[a??Bt,c??-Bt]}function th(n,e,t,i){let s=z_(n),r=z_(e);n==e&&(s==-1?(n*=t,e/=t):(n/=t,e*=t));let o=t==10?Us:gy,a=s==1?_i:Ii,c=r==1?Ii:_i,l=a(o(En(n))),h=c(o(En(e))),u=ko(t,l),d=ko(t,h);return t==10&&(l<0&&(u=kt(u,-l)),h<0&&(d=kt(d,-h))),i||t==2?(n=u*s,e=d*r):(n=vy(n,u),e=nh(e,d)),[n,e]}function rp(n,e,t,i){let s=th(n,e,t,i);return n==0&&(s[0]=0),e==0&&(s[1]=0),s}var op=.1,G_={mode:3,pad:op},ll={pad:0,soft:null,mode:0},xw={min:ll,max:ll};function ju(n,e,t,i){return ih(t)?V_(n,e,t):(ll.pad=t,ll.soft=i?0:null,ll.mode=i?3:0,V_(n,e,xw))}function bt(n,e){return n??e}function vw(n,e,t){for(e=bt(e,0),t=bt(t,n.length-1);e<=t;){if(n[e]!=null)return!0;e++}return!1}function V_(n,e,t){let i=t.min,s=t.max,r=bt(i.pad,0),o=bt(s.pad,0),a=bt(i.hard,-Bt),c=bt(s.hard,Bt),l=bt(i.soft,Bt),h=bt(s.soft,-Bt),u=bt(i.mode,0),d=bt(s.mode,0),f=e-n,g=Us(f),v=qn(En(n),En(e)),p=Us(v),m=En(p-g);(f<1e-24||m>10)&&(f=0,(n==0||e==0)&&(f=1e-24,u==2&&l!=Bt&&(r=0),d==2&&h!=-Bt&&(o=0)));let b=f||v||1e3,C=Us(b),E=ko(10,_i(C)),I=b*(f==0?n==0?.1:1:r),T=kt(vy(n-I,E/10),24),y=n>=l&&(u==1||u==3&&T<=l||u==2&&T>=l)?l:Bt,A=qn(a,T<y&&n>=y?y:Zi(y,T)),B=b*(f==0?e==0?.1:1:o),D=kt(nh(e+B,E/10),24),L=e<=h&&(d==1||d==3&&D>=h||d==2&&D<=h)?h:-Bt,k=Zi(c,D>L&&e<=L?L:qn(L,D));return A==k&&A==0&&(k=100),[A,k]}var bw=new Intl.NumberFormat(Ho?mw.language:"en-US"),ap=n=>bw.format(n),yi=Math,qu=yi.PI,En=yi.abs,_i=yi.floor,Mn=yi.round,Ii=yi.ceil,Zi=yi.min,qn=yi.max,ko=yi.pow,z_=yi.sign,Us=yi.log10,gy=yi.log2,Sw=(n,e=1)=>yi.sinh(n)*e,zf=(n,e=1)=>yi.asinh(n/e),Bt=1/0;function H_(n){return(Us((n^n>>31)-(n>>31))|0)+1}function qf(n,e,t){return Zi(qn(n,e),t)}function _y(n){return typeof n=="function"}function yt(n){return _y(n)?n:()=>n}var Mw=()=>{},yy=n=>n,xy=(n,e)=>e,Ew=n=>null,W_=n=>!0,X_=(n,e)=>n==e,Aw=/\.\d*?(?=9{6,}|0{6,})/gm,Br=n=>{if(Sy(n)||hr.has(n))return n;let e=`${n}`,t=e.match(Aw);if(t==null)return n;let i=t[0].length-1;if(e.indexOf("e-")!=-1){let[s,r]=e.split("e");return+`${Br(s)}e${r}`}return kt(n,i)};function Dr(n,e){return Br(kt(Br(n/e))*e)}function nh(n,e){return Br(Ii(Br(n/e))*e)}function vy(n,e){return Br(_i(Br(n/e))*e)}function kt(n,e=0){if(Sy(n))return n;let t=10**e,i=n*t*(1+Number.EPSILON);return Mn(i)/t}var hr=new Map;function by(n){return((""+n).split(".")[1]||"").length}function ul(n,e,t,i){let s=[],r=i.map(by);for(let o=e;o<t;o++){let a=En(o),c=kt(ko(n,o),a);for(let l=0;l<i.length;l++){let h=n==10?+`${i[l]}e${o}`:i[l]*c,u=(o>=0?0:a)+(o>=r[l]?0:r[l]),d=n==10?h:kt(h,u);s.push(d),hr.set(d,u)}}return s}var cl={},lp=[],Go=[null,null],ur=Array.isArray,Sy=Number.isInteger,Tw=n=>n===void 0;function Y_(n){return typeof n=="string"}function ih(n){let e=!1;if(n!=null){let t=n.constructor;e=t==null||t==Object}return e}function ww(n){return n!=null&&typeof n=="object"}var Rw=Object.getPrototypeOf(Uint8Array),My="__proto__";function Vo(n,e=ih){let t;if(ur(n)){let i=n.find(s=>s!=null);if(ur(i)||e(i)){t=Array(n.length);for(let s=0;s<n.length;s++)t[s]=Vo(n[s],e)}else t=n.slice()}else if(n instanceof Rw)t=n.slice();else if(e(n)){t={};for(let i in n)i!=My&&(t[i]=Vo(n[i],e))}else t=n;return t}function gn(n){let e=arguments;for(let t=1;t<e.length;t++){let i=e[t];for(let s in i)s!=My&&(ih(n[s])?gn(n[s],Vo(i[s])):n[s]=Vo(i[s]))}return n}var Cw=0,Iw=1,Nw=2;function Pw(n,e,t){for(let i=0,s,r=-1;i<e.length;i++){let o=e[i];if(o>r){for(s=o-1;s>=0&&n[s]==null;)n[s--]=null;for(s=o+1;s<t&&n[s]==null;)n[r=s++]=null}}}function Lw(n,e){if(Uw(n)){let o=n[0].slice();for(let a=1;a<n.length;a++)o.push(...n[a].slice(1));return Ow(o[0])||(o=Fw(o)),o}let t=new Set;for(let o=0;o<n.length;o++){let c=n[o][0],l=c.length;for(let h=0;h<l;h++)t.add(c[h])}let i=[Array.from(t).sort((o,a)=>o-a)],s=i[0].length,r=new Map;for(let o=0;o<s;o++)r.set(i[0][o],o);for(let o=0;o<n.length;o++){let a=n[o],c=a[0];for(let l=1;l<a.length;l++){let h=a[l],u=Array(s).fill(void 0),d=e?e[o][l]:Iw,f=[];for(let g=0;g<h.length;g++){let v=h[g],p=r.get(c[g]);v===null?d!=Cw&&(u[p]=v,d==Nw&&f.push(p)):u[p]=v}Pw(u,f,s),i.push(u)}}return i}var Dw=typeof queueMicrotask>"u"?n=>Promise.resolve().then(n):queueMicrotask;function Fw(n){let e=n[0],t=e.length,i=Array(t);for(let r=0;r<i.length;r++)i[r]=r;i.sort((r,o)=>e[r]-e[o]);let s=[];for(let r=0;r<n.length;r++){let o=n[r],a=Array(t);for(let c=0;c<t;c++)a[c]=o[i[c]];s.push(a)}return s}function Uw(n){let e=n[0][0],t=e.length;for(let i=1;i<n.length;i++){let s=n[i][0];if(s.length!=t)return!1;if(s!=e){for(let r=0;r<t;r++)if(s[r]!=e[r])return!1}}return!0}function Ow(n,e=100){let t=n.length;if(t<=1)return!0;let i=0,s=t-1;for(;i<=s&&n[i]==null;)i++;for(;s>=i&&n[s]==null;)s--;if(s<=i)return!0;let r=qn(1,_i((s-i+1)/e));for(let o=n[i],a=i+r;a<=s;a+=r){let c=n[a];if(c!=null){if(c<=o)return!1;o=c}}return!0}var Ey=["January","February","March","April","May","June","July","August","September","October","November","December"],Ay=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function Ty(n){return n.slice(0,3)}var Bw=Ay.map(Ty),kw=Ey.map(Ty),Gw={MMMM:Ey,MMM:kw,WWWW:Ay,WWW:Bw};function sl(n){return(n<10?"0":"")+n}function Vw(n){return(n<10?"00":n<100?"0":"")+n}var zw={YYYY:n=>n.getFullYear(),YY:n=>(n.getFullYear()+"").slice(2),MMMM:(n,e)=>e.MMMM[n.getMonth()],MMM:(n,e)=>e.MMM[n.getMonth()],MM:n=>sl(n.getMonth()+1),M:n=>n.getMonth()+1,DD:n=>sl(n.getDate()),D:n=>n.getDate(),WWWW:(n,e)=>e.WWWW[n.getDay()],WWW:(n,e)=>e.WWW[n.getDay()],HH:n=>sl(n.getHours()),H:n=>n.getHours(),h:n=>{let e=n.getHours();return e==0?12:e>12?e-12:e},AA:n=>n.getHours()>=12?"PM":"AM",aa:n=>n.getHours()>=12?"pm":"am",a:n=>n.getHours()>=12?"p":"a",mm:n=>sl(n.getMinutes()),m:n=>n.getMinutes(),ss:n=>sl(n.getSeconds()),s:n=>n.getSeconds(),fff:n=>Vw(n.getMilliseconds())};function cp(n,e){e=e||Gw;let t=[],i=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=i.exec(n);)t.push(s[0][0]=="{"?zw[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<t.length;a++)o+=typeof t[a]=="string"?t[a]:t[a](r,e);return o}}var Hw=new Intl.DateTimeFormat().resolvedOptions().timeZone;function Ww(n,e){let t;return e=="UTC"||e=="Etc/UTC"?t=new Date(+n+n.getTimezoneOffset()*6e4):e==Hw?t=n:(t=new Date(n.toLocaleString("en-US",{timeZone:e})),t.setMilliseconds(n.getMilliseconds())),t}var wy=n=>n%1==0,Qu=[1,2,2.5,5],Xw=ul(10,-32,0,Qu),Ry=ul(10,0,32,Qu),Yw=Ry.filter(wy),Fr=Xw.concat(Ry),up=`
`,Cy="{YYYY}",Z_=up+Cy,Iy="{M}/{D}",al=up+Iy,Ku=al+"/{YY}",Ny="{aa}",Zw="{h}:{mm}",Oo=Zw+Ny,K_=up+Oo,$_=":{ss}",Rt=null;function Py(n){let e=n*1e3,t=e*60,i=t*60,s=i*24,r=s*30,o=s*365,c=(n==1?ul(10,0,3,Qu).filter(wy):ul(10,-3,0,Qu)).concat([e,e*5,e*10,e*15,e*30,t,t*5,t*10,t*15,t*30,i,i*2,i*3,i*4,i*6,i*8,i*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),l=[[o,Cy,Rt,Rt,Rt,Rt,Rt,Rt,1],[s*28,"{MMM}",Z_,Rt,Rt,Rt,Rt,Rt,1],[s,Iy,Z_,Rt,Rt,Rt,Rt,Rt,1],[i,"{h}"+Ny,Ku,Rt,al,Rt,Rt,Rt,1],[t,Oo,Ku,Rt,al,Rt,Rt,Rt,1],[e,$_,Ku+" "+Oo,Rt,al+" "+Oo,Rt,K_,Rt,1],[n,$_+".{fff}",Ku+" "+Oo,Rt,al+" "+Oo,Rt,K_,Rt,1]];function h(u){return(d,f,g,v,p,m)=>{let b=[],C=p>=o,E=p>=r&&p<o,I=u(g),T=kt(I*n,3),y=Hf(I.getFullYear(),C?0:I.getMonth(),E||C?1:I.getDate()),A=kt(y*n,3);if(E||C){let B=E?p/r:0,D=C?p/o:0,L=T==A?T:kt(Hf(y.getFullYear()+D,y.getMonth()+B,1)*n,3),k=new Date(Mn(L/n)),z=k.getFullYear(),P=k.getMonth();for(let W=0;L<=v;W++){let K=Hf(z+D*W,P+B*W,1),V=K-u(kt(K*n,3));L=kt((+K+V)*n,3),L<=v&&b.push(L)}}else{let B=p>=s?s:p,D=_i(g)-_i(T),L=A+D+nh(T-A,B);b.push(L);let k=u(L),z=k.getHours()+k.getMinutes()/t+k.getSeconds()/i,P=p/i,W=d.axes[f]._space,K=m/W;for(;L=kt(L+p,n==1?0:3),!(L>v);)if(P>1){let V=_i(kt(z+P,6))%24,ee=u(L).getHours()-V;ee>1&&(ee=-1),L-=ee*i,z=(z+P)%24;let re=b[b.length-1];kt((L-re)/p,3)*K>=.7&&b.push(L)}else b.push(L)}return b}}return[c,l,h]}var[Kw,$w,qw]=Py(1),[Jw,jw,Qw]=Py(.001);ul(2,-53,53,[1]);function q_(n,e){return n.map(t=>t.map((i,s)=>s==0||s==8||i==null?i:e(s==1||t[8]==0?i:t[1]+i)))}function J_(n,e){return(t,i,s,r,o)=>{let a=e.find(g=>o>=g[0])||e[e.length-1],c,l,h,u,d,f;return i.map(g=>{let v=n(g),p=v.getFullYear(),m=v.getMonth(),b=v.getDate(),C=v.getHours(),E=v.getMinutes(),I=v.getSeconds(),T=p!=c&&a[2]||m!=l&&a[3]||b!=h&&a[4]||C!=u&&a[5]||E!=d&&a[6]||I!=f&&a[7]||a[1];return c=p,l=m,h=b,u=C,d=E,f=I,T(v)})}}function e1(n,e){let t=cp(e);return(i,s,r,o,a)=>s.map(c=>t(n(c)))}function Hf(n,e,t){return new Date(n,e,t)}function j_(n,e){return e(n)}var t1="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Q_(n,e){return(t,i,s,r)=>r==null?ip:e(n(i))}function n1(n,e){let t=n.series[e];return t.width?t.stroke(n,e):t.points.width?t.points.stroke(n,e):null}function i1(n,e){return n.series[e].fill(n,e)}var s1={show:!0,live:!0,isolate:!1,mount:Mw,markers:{show:!0,width:2,stroke:n1,fill:i1,dash:"solid"},idx:null,idxs:null,values:[]};function r1(n,e){let t=n.cursor.points,i=Ci(),s=t.size(n,e);Zt(i,rl,s),Zt(i,ol,s);let r=s/-2;Zt(i,"marginLeft",r),Zt(i,"marginTop",r);let o=t.width(n,e,s);return o&&Zt(i,"borderWidth",o),i}function o1(n,e){let t=n.series[e].points;return t._fill||t._stroke}function a1(n,e){let t=n.series[e].points;return t._stroke||t._fill}function l1(n,e){return n.series[e].points.size}var Wf=[0,0];function c1(n,e,t){return Wf[0]=e,Wf[1]=t,Wf}function $u(n,e,t,i=!0){return s=>{s.button==0&&(!i||s.target==e)&&t(s)}}function Xf(n,e,t,i=!0){return s=>{(!i||s.target==e)&&t(s)}}var u1={show:!0,x:!0,y:!0,lock:!1,move:c1,points:{one:!1,show:r1,size:l1,width:0,stroke:a1,fill:o1},bind:{mousedown:$u,mouseup:$u,click:$u,dblclick:$u,mousemove:Xf,mouseleave:Xf,mouseenter:Xf},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(n,e)=>{e.stopPropagation(),e.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(n,e,t,i,s)=>i-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Ly={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},hp=gn({},Ly,{filter:xy}),Dy=gn({},hp,{size:10}),Fy=gn({},Ly,{show:!1}),dp='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Uy="bold "+dp,Oy=1.5,ey={show:!0,scale:"x",stroke:np,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Uy,side:2,grid:hp,ticks:Dy,border:Fy,font:dp,lineGap:Oy,rotate:0},h1="Value",d1="Time",ty={show:!0,scale:"x",auto:!1,sorted:1,min:Bt,max:-Bt,idxs:[]};function f1(n,e,t,i,s){return e.map(r=>r==null?"":ap(r))}function p1(n,e,t,i,s,r,o){let a=[],c=hr.get(s)||0;t=o?t:kt(nh(t,s),c);for(let l=t;l<=i;l=kt(l+s,c))a.push(Object.is(l,-0)?0:l);return a}function Jf(n,e,t,i,s,r,o){let a=[],c=n.scales[n.axes[e].scale].log,l=c==10?Us:gy,h=_i(l(t));s=ko(c,h),c==10&&(s=Fr[Yi(s,Fr)]);let u=t,d=s*c;c==10&&(d=Fr[Yi(d,Fr)]);do a.push(u),u=u+s,c==10&&!hr.has(u)&&(u=kt(u,hr.get(s))),u>=d&&(s=u,d=s*c,c==10&&(d=Fr[Yi(d,Fr)]));while(u<=i);return a}function m1(n,e,t,i,s,r,o){let c=n.scales[n.axes[e].scale].asinh,l=i>c?Jf(n,e,qn(c,t),i,s):[c],h=i>=0&&t<=0?[0]:[];return(t<-c?Jf(n,e,qn(c,-i),-t,s):[c]).reverse().map(d=>-d).concat(h,l)}var By=/./,g1=/[12357]/,_1=/[125]/,ny=/1/,jf=(n,e,t,i)=>n.map((s,r)=>e==4&&s==0||r%i==0&&t.test(s.toExponential()[s<0?1:0])?s:null);function y1(n,e,t,i,s){let r=n.axes[t],o=r.scale,a=n.scales[o],c=n.valToPos,l=r._space,h=c(10,o),u=c(9,o)-h>=l?By:c(7,o)-h>=l?g1:c(5,o)-h>=l?_1:ny;if(u==ny){let d=En(c(1,o)-h);if(d<l)return jf(e.slice().reverse(),a.distr,u,Ii(l/d)).reverse()}return jf(e,a.distr,u,1)}function x1(n,e,t,i,s){let r=n.axes[t],o=r.scale,a=r._space,c=n.valToPos,l=En(c(1,o)-c(2,o));return l<a?jf(e.slice().reverse(),3,By,Ii(a/l)).reverse():e}function v1(n,e,t,i){return i==null?ip:e==null?"":ap(e)}var iy={show:!0,scale:"y",stroke:np,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Uy,side:3,grid:hp,ticks:Dy,border:Fy,font:dp,lineGap:Oy,rotate:0};function b1(n,e){let t=3+(n||1)*2;return kt(t*e,3)}function S1(n,e){let{scale:t,idxs:i}=n.series[0],s=n._data[0],r=n.valToPos(s[i[0]],t,!0),o=n.valToPos(s[i[1]],t,!0),a=En(o-r),c=n.series[e],l=a/(c.points.space*Mt);return i[1]-i[0]<=l}var sy={scale:null,auto:!0,sorted:0,min:Bt,max:-Bt},ky=(n,e,t,i,s)=>s,ry={show:!0,auto:!0,sorted:0,gaps:ky,alpha:1,facets:[gn({},sy,{scale:"x"}),gn({},sy,{scale:"y"})]},oy={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:ky,alpha:1,points:{show:S1,filter:null},values:null,min:Bt,max:-Bt,idxs:[],path:null,clip:null};function M1(n,e,t,i,s){return t/10}var Gy={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},E1=gn({},Gy,{time:!1,ori:1}),ay={};function Vy(n,e){let t=ay[n];return t||(t={key:n,plots:[],sub(i){t.plots.push(i)},unsub(i){t.plots=t.plots.filter(s=>s!=i)},pub(i,s,r,o,a,c,l){for(let h=0;h<t.plots.length;h++)t.plots[h]!=s&&t.plots[h].pub(i,s,r,o,a,c,l)}},n!=null&&(ay[n]=t)),t}var zo=1,Qf=2;function kr(n,e,t){let i=n.mode,s=n.series[e],r=i==2?n._data[e]:n._data,o=n.scales,a=n.bbox,c=r[0],l=i==2?r[1]:r[e],h=i==2?o[s.facets[0].scale]:o[n.series[0].scale],u=i==2?o[s.facets[1].scale]:o[s.scale],d=a.left,f=a.top,g=a.width,v=a.height,p=n.valToPosH,m=n.valToPosV;return h.ori==0?t(s,c,l,h,u,p,m,d,f,g,v,rh,Wo,ah,Hy,Xy):t(s,c,l,h,u,m,p,f,d,v,g,oh,Xo,mp,Wy,Yy)}function fp(n,e){let t=0,i=0,s=bt(n.bands,lp);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==e?t=o.dir:o.series[1]==e&&(o.dir==1?i|=1:i|=2)}return[t,i==1?-1:i==2?1:i==3?2:0]}function A1(n,e,t,i,s){let r=n.mode,o=n.series[e],a=r==2?o.facets[1].scale:o.scale,c=n.scales[a];return s==-1?c.min:s==1?c.max:c.distr==3?c.dir==1?c.min:c.max:0}function Os(n,e,t,i,s,r){return kr(n,e,(o,a,c,l,h,u,d,f,g,v,p)=>{let m=o.pxRound,b=l.dir*(l.ori==0?1:-1),C=l.ori==0?Wo:Xo,E,I;b==1?(E=t,I=i):(E=i,I=t);let T=m(u(a[E],l,v,f)),y=m(d(c[E],h,p,g)),A=m(u(a[I],l,v,f)),B=m(d(r==1?h.max:h.min,h,p,g)),D=new Path2D(s);return C(D,A,B),C(D,T,B),C(D,T,y),D})}function sh(n,e,t,i,s,r){let o=null;if(n.length>0){o=new Path2D;let a=e==0?ah:mp,c=t;for(let u=0;u<n.length;u++){let d=n[u];if(d[1]>d[0]){let f=d[0]-c;f>0&&a(o,c,i,f,i+r),c=d[1]}}let l=t+s-c,h=10;l>0&&a(o,c,i-h/2,l,i+r+h)}return o}function T1(n,e,t){let i=n[n.length-1];i&&i[0]==e?i[1]=t:n.push([e,t])}function pp(n,e,t,i,s,r,o){let a=[],c=n.length;for(let l=s==1?t:i;l>=t&&l<=i;l+=s)if(e[l]===null){let u=l,d=l;if(s==1)for(;++l<=i&&e[l]===null;)d=l;else for(;--l>=t&&e[l]===null;)d=l;let f=r(n[u]),g=d==u?f:r(n[d]),v=u-s;f=o<=0&&v>=0&&v<c?r(n[v]):f;let m=d+s;g=o>=0&&m>=0&&m<c?r(n[m]):g,g>=f&&a.push([f,g])}return a}function ly(n){return n==0?yy:n==1?Mn:e=>Dr(e,n)}function zy(n){let e=n==0?rh:oh,t=n==0?(s,r,o,a,c,l)=>{s.arcTo(r,o,a,c,l)}:(s,r,o,a,c,l)=>{s.arcTo(o,r,c,a,l)},i=n==0?(s,r,o,a,c)=>{s.rect(r,o,a,c)}:(s,r,o,a,c)=>{s.rect(o,r,c,a)};return(s,r,o,a,c,l=0,h=0)=>{l==0&&h==0?i(s,r,o,a,c):(l=Zi(l,a/2,c/2),h=Zi(h,a/2,c/2),e(s,r+l,o),t(s,r+a,o,r+a,o+c,l),t(s,r+a,o+c,r,o+c,h),t(s,r,o+c,r,o,h),t(s,r,o,r+a,o,l),s.closePath())}}var rh=(n,e,t)=>{n.moveTo(e,t)},oh=(n,e,t)=>{n.moveTo(t,e)},Wo=(n,e,t)=>{n.lineTo(e,t)},Xo=(n,e,t)=>{n.lineTo(t,e)},ah=zy(0),mp=zy(1),Hy=(n,e,t,i,s,r)=>{n.arc(e,t,i,s,r)},Wy=(n,e,t,i,s,r)=>{n.arc(t,e,i,s,r)},Xy=(n,e,t,i,s,r,o)=>{n.bezierCurveTo(e,t,i,s,r,o)},Yy=(n,e,t,i,s,r,o)=>{n.bezierCurveTo(t,e,s,i,o,r)};function Zy(n){return(e,t,i,s,r)=>kr(e,t,(o,a,c,l,h,u,d,f,g,v,p)=>{let{pxRound:m,points:b}=o,C,E;l.ori==0?(C=rh,E=Hy):(C=oh,E=Wy);let I=kt(b.width*Mt,3),T=(b.size-b.width)/2*Mt,y=kt(T*2,3),A=new Path2D,B=new Path2D,{left:D,top:L,width:k,height:z}=e.bbox;ah(B,D-y,L-y,k+y*2,z+y*2);let P=W=>{if(c[W]!=null){let K=m(u(a[W],l,v,f)),V=m(d(c[W],h,p,g));C(A,K+T,V),E(A,K,V,T,0,qu*2)}};if(r)r.forEach(P);else for(let W=i;W<=s;W++)P(W);return{stroke:I>0?A:null,fill:A,clip:B,flags:zo|Qf}})}function Ky(n){return(e,t,i,s,r,o)=>{i!=s&&(r!=i&&o!=i&&n(e,t,i),r!=s&&o!=s&&n(e,t,s),n(e,t,o))}}var w1=Ky(Wo),R1=Ky(Xo);function $y(n){let e=bt(n?.alignGaps,0);return(t,i,s,r)=>kr(t,i,(o,a,c,l,h,u,d,f,g,v,p)=>{[s,r]=eh(c,s,r);let m=o.pxRound,b=z=>m(u(z,l,v,f)),C=z=>m(d(z,h,p,g)),E,I;l.ori==0?(E=Wo,I=w1):(E=Xo,I=R1);let T=l.dir*(l.ori==0?1:-1),y={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:zo},A=y.stroke,B=!1;if(r-s>=v*4){let z=de=>t.posToVal(de,l.key,!0),P=null,W=null,K,V,ue,j=b(a[T==1?s:r]),ee=b(a[s]),re=b(a[r]),fe=z(T==1?ee+1:re-1);for(let de=T==1?s:r;de>=s&&de<=r;de+=T){let te=a[de],xe=(T==1?te<fe:te>fe)?j:b(te),Re=c[de];xe==j?Re!=null?(V=Re,P==null?(E(A,xe,C(V)),K=P=W=V):V<P?P=V:V>W&&(W=V)):Re===null&&(B=!0):(P!=null&&I(A,j,C(P),C(W),C(K),C(V)),Re!=null?(V=Re,E(A,xe,C(V)),P=W=K=V):(P=W=null,Re===null&&(B=!0)),j=xe,fe=z(j+T))}P!=null&&P!=W&&ue!=j&&I(A,j,C(P),C(W),C(K),C(V))}else for(let z=T==1?s:r;z>=s&&z<=r;z+=T){let P=c[z];P===null?B=!0:P!=null&&E(A,b(a[z]),C(P))}let[L,k]=fp(t,i);if(o.fill!=null||L!=0){let z=y.fill=new Path2D(A),P=o.fillTo(t,i,o.min,o.max,L),W=C(P),K=b(a[s]),V=b(a[r]);T==-1&&([V,K]=[K,V]),E(z,V,W),E(z,K,W)}if(!o.spanGaps){let z=[];B&&z.push(...pp(a,c,s,r,T,b,e)),y.gaps=z=o.gaps(t,i,s,r,z),y.clip=sh(z,l.ori,f,g,v,p)}return k!=0&&(y.band=k==2?[Os(t,i,s,r,A,-1),Os(t,i,s,r,A,1)]:Os(t,i,s,r,A,k)),y})}function C1(n){let e=bt(n.align,1),t=bt(n.ascDesc,!1),i=bt(n.alignGaps,0),s=bt(n.extend,!1);return(r,o,a,c)=>kr(r,o,(l,h,u,d,f,g,v,p,m,b,C)=>{[a,c]=eh(u,a,c);let E=l.pxRound,{left:I,width:T}=r.bbox,y=ee=>E(g(ee,d,b,p)),A=ee=>E(v(ee,f,C,m)),B=d.ori==0?Wo:Xo,D={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:zo},L=D.stroke,k=d.dir*(d.ori==0?1:-1),z=A(u[k==1?a:c]),P=y(h[k==1?a:c]),W=P,K=P;s&&e==-1&&(K=I,B(L,K,z)),B(L,P,z);for(let ee=k==1?a:c;ee>=a&&ee<=c;ee+=k){let re=u[ee];if(re==null)continue;let fe=y(h[ee]),de=A(re);e==1?B(L,fe,z):B(L,W,de),B(L,fe,de),z=de,W=fe}let V=W;s&&e==1&&(V=I+T,B(L,V,z));let[ue,j]=fp(r,o);if(l.fill!=null||ue!=0){let ee=D.fill=new Path2D(L),re=l.fillTo(r,o,l.min,l.max,ue),fe=A(re);B(ee,V,fe),B(ee,K,fe)}if(!l.spanGaps){let ee=[];ee.push(...pp(h,u,a,c,k,y,i));let re=l.width*Mt/2,fe=t||e==1?re:-re,de=t||e==-1?-re:re;ee.forEach(te=>{te[0]+=fe,te[1]+=de}),D.gaps=ee=l.gaps(r,o,a,c,ee),D.clip=sh(ee,d.ori,p,m,b,C)}return j!=0&&(D.band=j==2?[Os(r,o,a,c,L,-1),Os(r,o,a,c,L,1)]:Os(r,o,a,c,L,j)),D})}function cy(n,e,t,i,s,r,o=Bt){if(n.length>1){let a=null;for(let c=0,l=1/0;c<n.length;c++)if(e[c]!==void 0){if(a!=null){let h=En(n[c]-n[a]);h<l&&(l=h,o=En(t(n[c],i,s,r)-t(n[a],i,s,r)))}a=c}}return o}function I1(n){n=n||cl;let e=bt(n.size,[.6,Bt,1]),t=n.align||0,i=n.gap||0,s=n.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;let r=yt(s),o=1-e[0],a=bt(e[1],Bt),c=bt(e[2],1),l=bt(n.disp,cl),h=bt(n.each,f=>{}),{fill:u,stroke:d}=l;return(f,g,v,p)=>kr(f,g,(m,b,C,E,I,T,y,A,B,D,L)=>{let k=m.pxRound,z=t,P=i*Mt,W=a*Mt,K=c*Mt,V,ue;E.ori==0?[V,ue]=r(f,g):[ue,V]=r(f,g);let j=E.dir*(E.ori==0?1:-1),ee=E.ori==0?ah:mp,re=E.ori==0?h:(Ie,Ke,rt,Ee,Ut,Ve,Ye)=>{h(Ie,Ke,rt,Ut,Ee,Ye,Ve)},fe=bt(f.bands,lp).find(Ie=>Ie.series[0]==g),de=fe!=null?fe.dir:0,te=m.fillTo(f,g,m.min,m.max,de),ge=k(y(te,I,L,B)),xe,Re,Me,We=D,st=k(m.width*Mt),ze=!1,ut=null,at=null,nt=null,Kt=null;u!=null&&(st==0||d!=null)&&(ze=!0,ut=u.values(f,g,v,p),at=new Map,new Set(ut).forEach(Ie=>{Ie!=null&&at.set(Ie,new Path2D)}),st>0&&(nt=d.values(f,g,v,p),Kt=new Map,new Set(nt).forEach(Ie=>{Ie!=null&&Kt.set(Ie,new Path2D)})));let{x0:Gt,size:cn}=l;if(Gt!=null&&cn!=null){z=1,b=Gt.values(f,g,v,p),Gt.unit==2&&(b=b.map(rt=>f.posToVal(A+rt*D,E.key,!0)));let Ie=cn.values(f,g,v,p);cn.unit==2?Re=Ie[0]*D:Re=T(Ie[0],E,D,A)-T(0,E,D,A),We=cy(b,C,T,E,D,A,We),Me=We-Re+P}else We=cy(b,C,T,E,D,A,We),Me=We*o+P,Re=We-Me;Me<1&&(Me=0),st>=Re/2&&(st=0),Me<5&&(k=yy);let Lt=Me>0,Tn=We-Me-(Lt?st:0);Re=k(qf(Tn,K,W)),xe=(z==0?Re/2:z==j?0:Re)-z*j*((z==0?P/2:0)+(Lt?st/2:0));let xt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},_n=ze?null:new Path2D,jt=null;if(fe!=null)jt=f.data[fe.series[1]];else{let{y0:Ie,y1:Ke}=l;Ie!=null&&Ke!=null&&(C=Ke.values(f,g,v,p),jt=Ie.values(f,g,v,p))}let un=V*Re,U=ue*Re;for(let Ie=j==1?v:p;Ie>=v&&Ie<=p;Ie+=j){let Ke=C[Ie];if(Ke==null)continue;if(jt!=null){let Y=jt[Ie]??0;if(Ke-Y==0)continue;ge=y(Y,I,L,B)}let rt=E.distr!=2||l!=null?b[Ie]:Ie,Ee=T(rt,E,D,A),Ut=y(bt(Ke,te),I,L,B),Ve=k(Ee-xe),Ye=k(qn(Ut,ge)),w=k(Zi(Ut,ge)),x=Ye-w;if(Ke!=null){let Y=Ke<0?U:un,he=Ke<0?un:U;ze?(st>0&&nt[Ie]!=null&&ee(Kt.get(nt[Ie]),Ve,w+_i(st/2),Re,qn(0,x-st),Y,he),ut[Ie]!=null&&ee(at.get(ut[Ie]),Ve,w+_i(st/2),Re,qn(0,x-st),Y,he)):ee(_n,Ve,w+_i(st/2),Re,qn(0,x-st),Y,he),re(f,g,Ie,Ve-st/2,w,Re+st,x)}}return st>0?xt.stroke=ze?Kt:_n:ze||(xt._fill=m.width==0?m._fill:m._stroke??m._fill,xt.width=0),xt.fill=ze?at:_n,xt})}function N1(n,e){let t=bt(e?.alignGaps,0);return(i,s,r,o)=>kr(i,s,(a,c,l,h,u,d,f,g,v,p,m)=>{[r,o]=eh(l,r,o);let b=a.pxRound,C=V=>b(d(V,h,p,g)),E=V=>b(f(V,u,m,v)),I,T,y;h.ori==0?(I=rh,y=Wo,T=Xy):(I=oh,y=Xo,T=Yy);let A=h.dir*(h.ori==0?1:-1),B=C(c[A==1?r:o]),D=B,L=[],k=[];for(let V=A==1?r:o;V>=r&&V<=o;V+=A)if(l[V]!=null){let j=c[V],ee=C(j);L.push(D=ee),k.push(E(l[V]))}let z={stroke:n(L,k,I,y,T,b),fill:null,clip:null,band:null,gaps:null,flags:zo},P=z.stroke,[W,K]=fp(i,s);if(a.fill!=null||W!=0){let V=z.fill=new Path2D(P),ue=a.fillTo(i,s,a.min,a.max,W),j=E(ue);y(V,D,j),y(V,B,j)}if(!a.spanGaps){let V=[];V.push(...pp(c,l,r,o,A,C,t)),z.gaps=V=a.gaps(i,s,r,o,V),z.clip=sh(V,h.ori,g,v,p,m)}return K!=0&&(z.band=K==2?[Os(i,s,r,o,P,-1),Os(i,s,r,o,P,1)]:Os(i,s,r,o,P,K)),z})}function P1(n){return N1(L1,n)}function L1(n,e,t,i,s,r){let o=n.length;if(o<2)return null;let a=new Path2D;if(t(a,n[0],e[0]),o==2)i(a,n[1],e[1]);else{let c=Array(o),l=Array(o-1),h=Array(o-1),u=Array(o-1);for(let d=0;d<o-1;d++)h[d]=e[d+1]-e[d],u[d]=n[d+1]-n[d],l[d]=h[d]/u[d];c[0]=l[0];for(let d=1;d<o-1;d++)l[d]===0||l[d-1]===0||l[d-1]>0!=l[d]>0?c[d]=0:(c[d]=3*(u[d-1]+u[d])/((2*u[d]+u[d-1])/l[d-1]+(u[d]+2*u[d-1])/l[d]),isFinite(c[d])||(c[d]=0));c[o-1]=l[o-2];for(let d=0;d<o-1;d++)s(a,n[d]+u[d]/3,e[d]+c[d]*u[d]/3,n[d+1]-u[d]/3,e[d+1]-c[d+1]*u[d]/3,n[d+1],e[d+1])}return a}var ep=new Set;function uy(){for(let n of ep)n.syncRect(!0)}Ho&&(Or(fw,Bo,uy),Or(pw,Bo,uy,!0),Or(Ju,Bo,()=>{Un.pxRatio=Mt}));var D1=$y(),F1=Zy();function hy(n,e,t,i){return(i?[n[0],n[1]].concat(n.slice(2)):[n[0]].concat(n.slice(1))).map((r,o)=>tp(r,o,e,t))}function U1(n,e){return n.map((t,i)=>i==0?{}:gn({},e,t))}function tp(n,e,t,i){return gn({},e==0?t:i,n)}function qy(n,e,t){return e==null?Go:[e,t]}var O1=qy;function B1(n,e,t){return e==null?Go:ju(e,t,op,!0)}function Jy(n,e,t,i){return e==null?Go:th(e,t,n.scales[i].log,!1)}var k1=Jy;function jy(n,e,t,i){return e==null?Go:rp(e,t,n.scales[i].log,!1)}var G1=jy;function V1(n,e,t,i,s){let r=qn(H_(n),H_(e)),o=e-n,a=Yi(s/i*o,t);do{let c=t[a],l=i*c/o;if(l>=s&&r+(c<5?hr.get(c):0)<=17)return[c,l]}while(++a<t.length);return[0,0]}function dy(n){let e,t;return n=n.replace(/(\d+)px/,(i,s)=>(e=Mn((t=+s)*Mt))+"px"),[n,e,t]}function z1(n){n.show&&[n.font,n.labelFont].forEach(e=>{let t=kt(e[2]*Mt,1);e[0]=e[0].replace(/[0-9.]+px/,t+"px"),e[1]=t})}function Un(n,e,t){let i={mode:bt(n.mode,1)},s=i.mode;function r(_,S,R,N){let G=S.valToPct(_);return N+R*(S.dir==-1?1-G:G)}function o(_,S,R,N){let G=S.valToPct(_);return N+R*(S.dir==-1?G:1-G)}function a(_,S,R,N){return S.ori==0?r(_,S,R,N):o(_,S,R,N)}i.valToPosH=r,i.valToPosV=o;let c=!1;i.status=0;let l=i.root=Ci($T);if(n.id!=null&&(l.id=n.id),gi(l,n.class),n.title){let _=Ci(jT,l);_.textContent=n.title}let h=Xi("canvas"),u=i.ctx=h.getContext("2d"),d=Ci(QT,l);Or("click",d,_=>{_.target===g&&(Ht!=Zr||$t!=Kr)&&Dn.click(i,_)},!0);let f=i.under=Ci(ew,d);d.appendChild(h);let g=i.over=Ci(tw,d);n=Vo(n);let v=+bt(n.pxAlign,1),p=ly(v);(n.plugins||[]).forEach(_=>{_.opts&&(n=_.opts(i,n)||n)});let m=n.ms||.001,b=i.series=s==1?hy(n.series||[],ty,oy,!1):U1(n.series||[null],ry),C=i.axes=hy(n.axes||[],ey,iy,!0),E=i.scales={},I=i.bands=n.bands||[];I.forEach(_=>{_.fill=yt(_.fill||null),_.dir=bt(_.dir,-1)});let T=s==2?b[1].facets[0].scale:b[0].scale,y={axes:fs,series:dt},A=(n.drawOrder||["axes","series"]).map(_=>y[_]);function B(_){let S=_.distr==3?R=>Us(R>0?R:_.clamp(i,R,_.min,_.max,_.key)):_.distr==4?R=>zf(R,_.asinh):_.distr==100?R=>_.fwd(R):R=>R;return R=>{let N=S(R),{_min:G,_max:J}=_,le=J-G;return(N-G)/le}}function D(_){let S=E[_];if(S==null){let R=(n.scales||cl)[_]||cl;if(R.from!=null){D(R.from);let N=gn({},E[R.from],R,{key:_});N.valToPct=B(N),E[_]=N}else{S=E[_]=gn({},_==T?Gy:E1,R),S.key=_;let N=S.time,G=S.range,J=ur(G);if((_!=T||s==2&&!N)&&(J&&(G[0]==null||G[1]==null)&&(G={min:G[0]==null?G_:{mode:1,hard:G[0],soft:G[0]},max:G[1]==null?G_:{mode:1,hard:G[1],soft:G[1]}},J=!1),!J&&ih(G))){let le=G;G=(pe,be,De)=>be==null?Go:ju(be,De,le)}S.range=yt(G||(N?O1:_==T?S.distr==3?k1:S.distr==4?G1:qy:S.distr==3?Jy:S.distr==4?jy:B1)),S.auto=yt(J?!1:S.auto),S.clamp=yt(S.clamp||M1),S._min=S._max=null,S.valToPct=B(S)}}}D("x"),D("y"),s==1&&b.forEach(_=>{D(_.scale)}),C.forEach(_=>{D(_.scale)});for(let _ in n.scales)D(_);let L=E[T],k=L.distr,z,P;L.ori==0?(gi(l,qT),z=r,P=o):(gi(l,JT),z=o,P=r);let W={};for(let _ in E){let S=E[_];(S.min!=null||S.max!=null)&&(W[_]={min:S.min,max:S.max},S.min=S.max=null)}let K=n.tzDate||(_=>new Date(Mn(_/m))),V=n.fmtDate||cp,ue=m==1?qw(K):Qw(K),j=J_(K,q_(m==1?$w:jw,V)),ee=Q_(K,j_(t1,V)),re=[],fe=i.legend=gn({},s1,n.legend),de=i.cursor=gn({},u1,{drag:{y:s==2}},n.cursor),te=fe.show,ge=de.show,xe=fe.markers;fe.idxs=re,xe.width=yt(xe.width),xe.dash=yt(xe.dash),xe.stroke=yt(xe.stroke),xe.fill=yt(xe.fill);let Re,Me,We,st=[],ze=[],ut,at=!1,nt={};if(fe.live){let _=b[1]?b[1].values:null;at=_!=null,ut=at?_(i,1,0):{_:0};for(let S in ut)nt[S]=ip}if(te)if(Re=Xi("table",aw,l),We=Xi("tbody",null,Re),fe.mount(i,Re),at){Me=Xi("thead",null,Re,We);let _=Xi("tr",null,Me);Xi("th",null,_);for(var Kt in ut)Xi("th",w_,_).textContent=Kt}else gi(Re,cw),fe.live&&gi(Re,lw);let Gt={show:!0},cn={show:!1};function Lt(_,S){if(S==0&&(at||!fe.live||s==2))return Go;let R=[],N=Xi("tr",uw,We,We.childNodes[S]);gi(N,_.class),_.show||gi(N,Ur);let G=Xi("th",null,N);if(xe.show){let pe=Ci(hw,G);if(S>0){let be=xe.width(i,S);be&&(pe.style.border=be+"px "+xe.dash(i,S)+" "+xe.stroke(i,S)),pe.style.background=xe.fill(i,S)}}let J=Ci(w_,G);_.label instanceof HTMLElement?J.appendChild(_.label):J.textContent=_.label,S>0&&(xe.show||(J.style.color=_.width>0?xe.stroke(i,S):xe.fill(i,S)),xt("click",G,pe=>{if(de._lock)return;Je(pe);let be=b.indexOf(_);if((pe.ctrlKey||pe.metaKey)!=fe.isolate){let De=b.some((Fe,Oe)=>Oe>0&&Oe!=be&&Fe.show);b.forEach((Fe,Oe)=>{Oe>0&&ji(Oe,De?Oe==be?Gt:cn:Gt,!0,pn.setSeries)})}else ji(be,{show:!_.show},!0,pn.setSeries)},!1),je&&xt(N_,G,pe=>{de._lock||(Je(pe),ji(b.indexOf(_),qr,!0,pn.setSeries))},!1));for(var le in ut){let pe=Xi("td",dw,N);pe.textContent="--",R.push(pe)}return[N,R]}let Tn=new Map;function xt(_,S,R,N=!0){let G=Tn.get(S)||{},J=de.bind[_](i,S,R,N);J&&(Or(_,S,G[_]=J),Tn.set(S,G))}function _n(_,S,R){let N=Tn.get(S)||{};for(let G in N)(_==null||G==_)&&($f(G,S,N[G]),delete N[G]);_==null&&Tn.delete(S)}let jt=0,un=0,U=0,Ie=0,Ke=0,rt=0,Ee=Ke,Ut=rt,Ve=U,Ye=Ie,w=0,x=0,Y=0,he=0;i.bbox={};let ae=!1,ye=!1,ve=!1,ne=!1,se=!1,me=!1;function F(_,S,R){(R||_!=i.width||S!=i.height)&&oe(_,S),lt(!1),ve=!0,ye=!0,On()}function oe(_,S){i.width=jt=U=_,i.height=un=Ie=S,Ke=rt=0,Se(),He();let R=i.bbox;w=R.left=Dr(Ke*Mt,.5),x=R.top=Dr(rt*Mt,.5),Y=R.width=Dr(U*Mt,.5),he=R.height=Dr(Ie*Mt,.5)}let ie=3;function Ae(){let _=!1,S=0;for(;!_;){S++;let R=Wr(S),N=Ji(S);_=S==ie||R&&N,_||(oe(i.width,i.height),ye=!0)}}function _e({width:_,height:S}){F(_,S)}i.setSize=_e;function Se(){let _=!1,S=!1,R=!1,N=!1;C.forEach((G,J)=>{if(G.show&&G._show){let{side:le,_size:pe}=G,be=le%2,De=G.label!=null?G.labelSize:0,Fe=pe+De;Fe>0&&(be?(U-=Fe,le==3?(Ke+=Fe,N=!0):R=!0):(Ie-=Fe,le==0?(rt+=Fe,_=!0):S=!0))}}),$i[0]=_,$i[1]=R,$i[2]=S,$i[3]=N,U-=Ni[1]+Ni[3],Ke+=Ni[3],Ie-=Ni[2]+Ni[0],rt+=Ni[0]}function He(){let _=Ke+U,S=rt+Ie,R=Ke,N=rt;function G(J,le){switch(J){case 1:return _+=le,_-le;case 2:return S+=le,S-le;case 3:return R-=le,R+le;case 0:return N-=le,N+le}}C.forEach((J,le)=>{if(J.show&&J._show){let pe=J.side;J._pos=G(pe,J._size),J.label!=null&&(J._lpos=G(pe,J.labelSize))}})}if(de.dataIdx==null){let _=de.hover,S=_.skip=new Set(_.skip??[]);S.add(void 0);let R=_.prox=yt(_.prox),N=_.bias??=0;de.dataIdx=(G,J,le,pe)=>{if(J==0)return le;let be=le,De=R(G,J,le,pe)??Bt,Fe=De>=0&&De<Bt,Oe=L.ori==0?U:Ie,it=de.left,St=e[0],vt=e[J];if(S.has(vt[le])){be=null;let pt=null,qe=null,Xe;if(N==0||N==-1)for(Xe=le;pt==null&&Xe-- >0;)S.has(vt[Xe])||(pt=Xe);if(N==0||N==1)for(Xe=le;qe==null&&Xe++<vt.length;)S.has(vt[Xe])||(qe=Xe);if(pt!=null||qe!=null)if(Fe){let Xt=pt==null?-1/0:z(St[pt],L,Oe,0),tn=qe==null?1/0:z(St[qe],L,Oe,0),In=it-Xt,Dt=tn-it;In<=Dt?In<=De&&(be=pt):Dt<=De&&(be=qe)}else be=qe==null?pt:pt==null?qe:le-pt<=qe-le?pt:qe}else Fe&&En(it-z(St[le],L,Oe,0))>De&&(be=null);return be}}let Je=_=>{de.event=_};de.idxs=re,de._lock=!1;let ce=de.points;ce.show=yt(ce.show),ce.size=yt(ce.size),ce.stroke=yt(ce.stroke),ce.width=yt(ce.width),ce.fill=yt(ce.fill);let Be=i.focus=gn({},n.focus||{alpha:.3},de.focus),je=Be.prox>=0,Ce=je&&ce.one,ot=[],zt=[],zn=[];function Ko(_,S){let R=ce.show(i,S);if(R instanceof HTMLElement)return gi(R,ow),gi(R,_.class),ls(R,-10,-10,U,Ie),g.insertBefore(R,ot[S]),R}function Vr(_,S){if(s==1||S>0){let R=s==1&&E[_.scale].time,N=_.value;_.value=R?Y_(N)?Q_(K,j_(N,V)):N||ee:N||v1,_.label=_.label||(R?d1:h1)}if(Ce||S>0){_.width=_.width==null?1:_.width,_.paths=_.paths||D1||Ew,_.fillTo=yt(_.fillTo||A1),_.pxAlign=+bt(_.pxAlign,v),_.pxRound=ly(_.pxAlign),_.stroke=yt(_.stroke||null),_.fill=yt(_.fill||null),_._stroke=_._fill=_._paths=_._focus=null;let R=b1(qn(1,_.width),1),N=_.points=gn({},{size:R,width:qn(1,R*.2),stroke:_.stroke,space:R*2,paths:F1,_stroke:null,_fill:null},_.points);N.show=yt(N.show),N.filter=yt(N.filter),N.fill=yt(N.fill),N.stroke=yt(N.stroke),N.paths=yt(N.paths),N.pxAlign=_.pxAlign}if(te){let R=Lt(_,S);st.splice(S,0,R[0]),ze.splice(S,0,R[1]),fe.values.push(null)}if(ge){re.splice(S,0,null);let R=null;Ce?S==0&&(R=Ko(_,S)):S>0&&(R=Ko(_,S)),ot.splice(S,0,R),zt.splice(S,0,0),zn.splice(S,0,0)}Cn("addSeries",S)}function Th(_,S){S=S??b.length,_=s==1?tp(_,S,ty,oy):tp(_,S,{},ry),b.splice(S,0,_),Vr(b[S],S)}i.addSeries=Th;function ml(_){if(b.splice(_,1),te){fe.values.splice(_,1),ze.splice(_,1);let S=st.splice(_,1)[0];_n(null,S.firstChild),S.remove()}ge&&(re.splice(_,1),ot.splice(_,1)[0].remove(),zt.splice(_,1),zn.splice(_,1)),Cn("delSeries",_)}i.delSeries=ml;let $i=[!1,!1,!1,!1];function us(_,S){if(_._show=_.show,_.show){let R=_.side%2,N=E[_.scale];N==null&&(_.scale=R?b[1].scale:T,N=E[_.scale]);let G=N.time;_.size=yt(_.size),_.space=yt(_.space),_.rotate=yt(_.rotate),ur(_.incrs)&&_.incrs.forEach(le=>{!hr.has(le)&&hr.set(le,by(le))}),_.incrs=yt(_.incrs||(N.distr==2?Yw:G?m==1?Kw:Jw:Fr)),_.splits=yt(_.splits||(G&&N.distr==1?ue:N.distr==3?Jf:N.distr==4?m1:p1)),_.stroke=yt(_.stroke),_.grid.stroke=yt(_.grid.stroke),_.ticks.stroke=yt(_.ticks.stroke),_.border.stroke=yt(_.border.stroke);let J=_.values;_.values=ur(J)&&!ur(J[0])?yt(J):G?ur(J)?J_(K,q_(J,V)):Y_(J)?e1(K,J):J||j:J||f1,_.filter=yt(_.filter||(N.distr>=3&&N.log==10?y1:N.distr==3&&N.log==2?x1:xy)),_.font=dy(_.font),_.labelFont=dy(_.labelFont),_._size=_.size(i,null,S,0),_._space=_._rotate=_._incrs=_._found=_._splits=_._values=null,_._size>0&&($i[S]=!0,_._el=Ci(nw,d))}}function hs(_,S,R,N){let[G,J,le,pe]=R,be=S%2,De=0;return be==0&&(pe||J)&&(De=S==0&&!G||S==2&&!le?Mn(ey.size/3):0),be==1&&(G||le)&&(De=S==1&&!J||S==3&&!pe?Mn(iy.size/2):0),De}let $o=i.padding=(n.padding||[hs,hs,hs,hs]).map(_=>yt(bt(_,hs))),Ni=i._padding=$o.map((_,S)=>_(i,S,$i,0)),Qt,on=null,an=null,qi=s==1?b[0].idxs:null,ni=null,Bs=!1;function qo(_,S){if(e=_??[],i.data=i._data=e,s==2){Qt=0;for(let R=1;R<b.length;R++)Qt+=e[R][0].length}else{e.length==0&&(i.data=i._data=e=[[]]),ni=e[0],Qt=ni.length;let R=e;if(k==2){R=e.slice();let N=R[0]=Array(Qt);for(let G=0;G<Qt;G++)N[G]=G}i._data=e=R}if(lt(!0),Cn("setData"),k==2&&(ve=!0),S!==!1){let R=L;R.auto(i,Bs)?Jo():Vs(T,R.min,R.max),ne=ne||de.left>=0,me=!0,On()}}i.setData=qo;function Jo(){Bs=!0;let _,S;s==1&&(Qt>0?(on=qi[0]=0,an=qi[1]=Qt-1,_=e[0][on],S=e[0][an],k==2?(_=on,S=an):_==S&&(k==3?[_,S]=th(_,_,L.log,!1):k==4?[_,S]=rp(_,_,L.log,!1):L.time?S=_+Mn(86400/m):[_,S]=ju(_,S,op,!0))):(on=qi[0]=_=null,an=qi[1]=S=null)),Vs(T,_,S)}let zr,ks,Hr,M,O,Q,Z,$,Te,Ne;function we(_,S,R,N,G,J){_??=C_,R??=lp,N??="butt",G??=C_,J??="round",_!=zr&&(u.strokeStyle=zr=_),G!=ks&&(u.fillStyle=ks=G),S!=Hr&&(u.lineWidth=Hr=S),J!=O&&(u.lineJoin=O=J),N!=Q&&(u.lineCap=Q=N),R!=M&&u.setLineDash(M=R)}function Pe(_,S,R,N){S!=ks&&(u.fillStyle=ks=S),_!=Z&&(u.font=Z=_),R!=$&&(u.textAlign=$=R),N!=Te&&(u.textBaseline=Te=N)}function Ge(_,S,R,N,G=0){if(N.length>0&&_.auto(i,Bs)&&(S==null||S.min==null)){let J=bt(on,0),le=bt(an,N.length-1),pe=R.min==null?yw(N,J,le,G,_.distr==3):[R.min,R.max];_.min=Zi(_.min,R.min=pe[0]),_.max=qn(_.max,R.max=pe[1])}}let et={min:null,max:null};function ht(){for(let N in E){let G=E[N];W[N]==null&&(G.min==null||W[T]!=null&&G.auto(i,Bs))&&(W[N]=et)}for(let N in E){let G=E[N];W[N]==null&&G.from!=null&&W[G.from]!=null&&(W[N]=et)}W[T]!=null&&lt(!0);let _={};for(let N in W){let G=W[N];if(G!=null){let J=_[N]=Vo(E[N],ww);if(G.min!=null)gn(J,G);else if(N!=T||s==2)if(Qt==0&&J.from==null){let le=J.range(i,null,null,N);J.min=le[0],J.max=le[1]}else J.min=Bt,J.max=-Bt}}if(Qt>0){b.forEach((N,G)=>{if(s==1){let J=N.scale,le=W[J];if(le==null)return;let pe=_[J];if(G==0){let be=pe.range(i,pe.min,pe.max,J);pe.min=be[0],pe.max=be[1],on=Yi(pe.min,e[0]),an=Yi(pe.max,e[0]),an-on>1&&(e[0][on]<pe.min&&on++,e[0][an]>pe.max&&an--),N.min=ni[on],N.max=ni[an]}else N.show&&N.auto&&Ge(pe,le,N,e[G],N.sorted);N.idxs[0]=on,N.idxs[1]=an}else if(G>0&&N.show&&N.auto){let[J,le]=N.facets,pe=J.scale,be=le.scale,[De,Fe]=e[G],Oe=_[pe],it=_[be];Oe!=null&&Ge(Oe,W[pe],J,De,J.sorted),it!=null&&Ge(it,W[be],le,Fe,le.sorted),N.min=le.min,N.max=le.max}});for(let N in _){let G=_[N],J=W[N];if(G.from==null&&(J==null||J.min==null)){let le=G.range(i,G.min==Bt?null:G.min,G.max==-Bt?null:G.max,N);G.min=le[0],G.max=le[1]}}}for(let N in _){let G=_[N];if(G.from!=null){let J=_[G.from];if(J.min==null)G.min=G.max=null;else{let le=G.range(i,J.min,J.max,N);G.min=le[0],G.max=le[1]}}}let S={},R=!1;for(let N in _){let G=_[N],J=E[N];if(J.min!=G.min||J.max!=G.max){J.min=G.min,J.max=G.max;let le=J.distr;J._min=le==3?Us(J.min):le==4?zf(J.min,J.asinh):le==100?J.fwd(J.min):J.min,J._max=le==3?Us(J.max):le==4?zf(J.max,J.asinh):le==100?J.fwd(J.max):J.max,S[N]=R=!0}}if(R){b.forEach((N,G)=>{s==2?G>0&&S.y&&(N._paths=null):S[N.scale]&&(N._paths=null)});for(let N in S)ve=!0,Cn("setScale",N);ge&&de.left>=0&&(ne=me=!0)}for(let N in W)W[N]=null}function ke(_){let S=qf(on-1,0,Qt-1),R=qf(an+1,0,Qt-1);for(;_[S]==null&&S>0;)S--;for(;_[R]==null&&R<Qt-1;)R++;return[S,R]}function dt(){if(Qt>0){let _=b.some(S=>S._focus)&&Ne!=Be.alpha;_&&(u.globalAlpha=Ne=Be.alpha),b.forEach((S,R)=>{if(R>0&&S.show&&(qt(R,!1),qt(R,!0),S._paths==null)){let N=Ne;Ne!=S.alpha&&(u.globalAlpha=Ne=S.alpha);let G=s==2?[0,e[R][0].length-1]:ke(e[R]);S._paths=S.paths(i,R,G[0],G[1]),Ne!=N&&(u.globalAlpha=Ne=N)}}),b.forEach((S,R)=>{if(R>0&&S.show){let N=Ne;Ne!=S.alpha&&(u.globalAlpha=Ne=S.alpha),S._paths!=null&&Ct(R,!1);{let G=S._paths!=null?S._paths.gaps:null,J=S.points.show(i,R,on,an,G),le=S.points.filter(i,R,J,G);(J||le)&&(S.points._paths=S.points.paths(i,R,on,an,le),Ct(R,!0))}Ne!=N&&(u.globalAlpha=Ne=N),Cn("drawSeries",R)}}),_&&(u.globalAlpha=Ne=1)}}function qt(_,S){let R=S?b[_].points:b[_];R._stroke=R.stroke(i,_),R._fill=R.fill(i,_)}function Ct(_,S){let R=S?b[_].points:b[_],{stroke:N,fill:G,clip:J,flags:le,_stroke:pe=R._stroke,_fill:be=R._fill,_width:De=R.width}=R._paths;De=kt(De*Mt,3);let Fe=null,Oe=De%2/2;S&&be==null&&(be=De>0?"#fff":pe);let it=R.pxAlign==1&&Oe>0;if(it&&u.translate(Oe,Oe),!S){let St=w-De/2,vt=x-De/2,pt=Y+De,qe=he+De;Fe=new Path2D,Fe.rect(St,vt,pt,qe)}S?Ue(pe,De,R.dash,R.cap,be,N,G,le,J):It(_,pe,De,R.dash,R.cap,be,N,G,le,Fe,J),it&&u.translate(-Oe,-Oe)}function It(_,S,R,N,G,J,le,pe,be,De,Fe){let Oe=!1;be!=0&&I.forEach((it,St)=>{if(it.series[0]==_){let vt=b[it.series[1]],pt=e[it.series[1]],qe=(vt._paths||cl).band;ur(qe)&&(qe=it.dir==1?qe[0]:qe[1]);let Xe,Xt=null;vt.show&&qe&&vw(pt,on,an)?(Xt=it.fill(i,St)||J,Xe=vt._paths.clip):qe=null,Ue(S,R,N,G,Xt,le,pe,be,De,Fe,Xe,qe),Oe=!0}}),Oe||Ue(S,R,N,G,J,le,pe,be,De,Fe)}let yn=zo|Qf;function Ue(_,S,R,N,G,J,le,pe,be,De,Fe,Oe){we(_,S,R,N,G),(be||De||Oe)&&(u.save(),be&&u.clip(be),De&&u.clip(De)),Oe?(pe&yn)==yn?(u.clip(Oe),Fe&&u.clip(Fe),mt(G,le),hn(_,J,S)):pe&Qf?(mt(G,le),u.clip(Oe),hn(_,J,S)):pe&zo&&(u.save(),u.clip(Oe),Fe&&u.clip(Fe),mt(G,le),u.restore(),hn(_,J,S)):(mt(G,le),hn(_,J,S)),(be||De||Oe)&&u.restore()}function hn(_,S,R){R>0&&(S instanceof Map?S.forEach((N,G)=>{u.strokeStyle=zr=G,u.stroke(N)}):S!=null&&_&&u.stroke(S))}function mt(_,S){S instanceof Map?S.forEach((R,N)=>{u.fillStyle=ks=N,u.fill(R)}):S!=null&&_&&u.fill(S)}function ds(_,S,R,N){let G=C[_],J;if(N<=0)J=[0,0];else{let le=G._space=G.space(i,_,S,R,N),pe=G._incrs=G.incrs(i,_,S,R,N,le);J=V1(S,R,pe,N,le)}return G._found=J}function dn(_,S,R,N,G,J,le,pe,be,De){let Fe=le%2/2;v==1&&u.translate(Fe,Fe),we(pe,le,be,De,pe),u.beginPath();let Oe,it,St,vt,pt=G+(N==0||N==3?-J:J);R==0?(it=G,vt=pt):(Oe=G,St=pt);for(let qe=0;qe<_.length;qe++)S[qe]!=null&&(R==0?Oe=St=_[qe]:it=vt=_[qe],u.moveTo(Oe,it),u.lineTo(St,vt));u.stroke(),v==1&&u.translate(-Fe,-Fe)}function Wr(_){let S=!0;return C.forEach((R,N)=>{if(!R.show)return;let G=E[R.scale];if(G.min==null){R._show&&(S=!1,R._show=!1,lt(!1));return}else R._show||(S=!1,R._show=!0,lt(!1));let J=R.side,le=J%2,{min:pe,max:be}=G,[De,Fe]=ds(N,pe,be,le==0?U:Ie);if(Fe==0)return;let Oe=G.distr==2,it=R._splits=R.splits(i,N,pe,be,De,Fe,Oe),St=G.distr==2?it.map(Xe=>ni[Xe]):it,vt=G.distr==2?ni[it[1]]-ni[it[0]]:De,pt=R._values=R.values(i,R.filter(i,St,N,Fe,vt),N,Fe,vt);R._rotate=J==2?R.rotate(i,pt,N,Fe):0;let qe=R._size;R._size=Ii(R.size(i,pt,N,_)),qe!=null&&R._size!=qe&&(S=!1)}),S}function Ji(_){let S=!0;return $o.forEach((R,N)=>{let G=R(i,N,$i,_);G!=Ni[N]&&(S=!1),Ni[N]=G}),S}function fs(){for(let _=0;_<C.length;_++){let S=C[_];if(!S.show||!S._show)continue;let R=S.side,N=R%2,G,J,le=S.stroke(i,_),pe=R==0||R==3?-1:1,[be,De]=S._found;if(S.label!=null){let Xn=S.labelGap*pe,ri=Mn((S._lpos+Xn)*Mt);Pe(S.labelFont[0],le,"center",R==2?"top":R_),u.save(),N==1?(G=J=0,u.translate(ri,Mn(x+he/2)),u.rotate((R==3?-qu:qu)/2)):(G=Mn(w+Y/2),J=ri);let mr=_y(S.label)?S.label(i,_,be,De):S.label;u.fillText(mr,G,J),u.restore()}if(De==0)continue;let Fe=E[S.scale],Oe=N==0?Y:he,it=N==0?w:x,St=S._splits,vt=Fe.distr==2?St.map(Xn=>ni[Xn]):St,pt=Fe.distr==2?ni[St[1]]-ni[St[0]]:be,qe=S.ticks,Xe=S.border,Xt=qe.show?qe.size:0,tn=Mn(Xt*Mt),In=Mn((S.alignTo==2?S._size-Xt-S.gap:S.gap)*Mt),Dt=S._rotate*-qu/180,nn=p(S._pos*Mt),ii=(tn+In)*pe,Wn=nn+ii;J=N==0?Wn:0,G=N==1?Wn:0;let xi=S.font[0],Pi=S.align==1?Uo:S.align==2?kf:Dt>0?Uo:Dt<0?kf:N==0?"center":R==3?kf:Uo,es=Dt||N==1?"middle":R==2?"top":R_;Pe(xi,le,Pi,es);let si=S.font[1]*S.lineGap,vi=St.map(Xn=>p(a(Xn,Fe,Oe,it))),Li=S._values;for(let Xn=0;Xn<Li.length;Xn++){let ri=Li[Xn];if(ri!=null){N==0?G=vi[Xn]:J=vi[Xn],ri=""+ri;let mr=ri.indexOf(`
`)==-1?[ri]:ri.split(/\n/gm);for(let Yn=0;Yn<mr.length;Yn++){let Wp=mr[Yn];Dt?(u.save(),u.translate(G,J+Yn*si),u.rotate(Dt),u.fillText(Wp,0,0),u.restore()):u.fillText(Wp,G,J+Yn*si)}}}qe.show&&dn(vi,qe.filter(i,vt,_,De,pt),N,R,nn,tn,kt(qe.width*Mt,3),qe.stroke(i,_),qe.dash,qe.cap);let ts=S.grid;ts.show&&dn(vi,ts.filter(i,vt,_,De,pt),N,N==0?2:1,N==0?x:w,N==0?he:Y,kt(ts.width*Mt,3),ts.stroke(i,_),ts.dash,ts.cap),Xe.show&&dn([nn],[1],N==0?1:0,N==0?1:2,N==1?x:w,N==1?he:Y,kt(Xe.width*Mt,3),Xe.stroke(i,_),Xe.dash,Xe.cap)}Cn("drawAxes")}function lt(_){b.forEach((S,R)=>{R>0&&(S._paths=null,_&&(s==1?(S.min=null,S.max=null):S.facets.forEach(N=>{N.min=null,N.max=null})))})}let en=!1,Hn=!1,Nt=[];function fn(){Hn=!1;for(let _=0;_<Nt.length;_++)Cn(...Nt[_]);Nt.length=0}function On(){en||(Dw(Tp),en=!0)}function gl(_,S=!1){en=!0,Hn=S,_(i),Tp(),S&&Nt.length>0&&queueMicrotask(fn)}i.batch=gl;function Tp(){if(ae&&(ht(),ae=!1),ve&&(Ae(),ve=!1),ye){if(Zt(f,Uo,Ke),Zt(f,"top",rt),Zt(f,rl,U),Zt(f,ol,Ie),Zt(g,Uo,Ke),Zt(g,"top",rt),Zt(g,rl,U),Zt(g,ol,Ie),Zt(d,rl,jt),Zt(d,ol,un),h.width=Mn(jt*Mt),h.height=Mn(un*Mt),C.forEach(({_el:_,_show:S,_size:R,_pos:N,side:G})=>{if(_!=null)if(S){let J=G===3||G===0?R:0,le=G%2==1;Zt(_,le?"left":"top",N-J),Zt(_,le?"width":"height",R),Zt(_,le?"top":"left",le?rt:Ke),Zt(_,le?"height":"width",le?Ie:U),Kf(_,Ur)}else gi(_,Ur)}),zr=ks=Hr=O=Q=Z=$=Te=M=null,Ne=1,ea(!0),Ke!=Ee||rt!=Ut||U!=Ve||Ie!=Ye){lt(!1);let _=U/Ve,S=Ie/Ye;if(ge&&!ne&&de.left>=0){de.left*=_,de.top*=S,Xr&&ls(Xr,Mn(de.left),0,U,Ie),Yr&&ls(Yr,0,Mn(de.top),U,Ie);for(let R=0;R<ot.length;R++){let N=ot[R];N!=null&&(zt[R]*=_,zn[R]*=S,ls(N,Ii(zt[R]),Ii(zn[R]),U,Ie))}}if(Wt.show&&!se&&Wt.left>=0&&Wt.width>0){Wt.left*=_,Wt.width*=_,Wt.top*=S,Wt.height*=S;for(let R in Ph)Zt($r,R,Wt[R])}Ee=Ke,Ut=rt,Ve=U,Ye=Ie}Cn("setSize"),ye=!1}jt>0&&un>0&&(u.clearRect(0,0,h.width,h.height),Cn("drawClear"),A.forEach(_=>_()),Cn("draw")),Wt.show&&se&&(_l(Wt),se=!1),ge&&ne&&(pr(null,!0,!1),ne=!1),fe.show&&fe.live&&me&&(Ih(),me=!1),c||(c=!0,i.status=1,Cn("ready")),Bs=!1,en=!1}i.redraw=(_,S)=>{ve=S||!1,_!==!1?Vs(T,L.min,L.max):On()};function wh(_,S){let R=E[_];if(R.from==null){if(Qt==0){let N=R.range(i,S.min,S.max,_);S.min=N[0],S.max=N[1]}if(S.min>S.max){let N=S.min;S.min=S.max,S.max=N}if(Qt>1&&S.min!=null&&S.max!=null&&S.max-S.min<1e-16)return;_==T&&R.distr==2&&Qt>0&&(S.min=Yi(S.min,e[0]),S.max=Yi(S.max,e[0]),S.min==S.max&&S.max++),W[_]=S,ae=!0,On()}}i.setScale=wh;let Rh,Ch,Xr,Yr,wp,Rp,Zr,Kr,Cp,Ip,Ht,$t,Gs=!1,Dn=de.drag,wn=Dn.x,Rn=Dn.y;ge&&(de.x&&(Rh=Ci(sw,g)),de.y&&(Ch=Ci(rw,g)),L.ori==0?(Xr=Rh,Yr=Ch):(Xr=Ch,Yr=Rh),Ht=de.left,$t=de.top);let Wt=i.select=gn({show:!0,over:!0,left:0,width:0,top:0,height:0},n.select),$r=Wt.show?Ci(iw,Wt.over?g:f):null;function _l(_,S){if(Wt.show){for(let R in _)Wt[R]=_[R],R in Ph&&Zt($r,R,_[R]);S!==!1&&Cn("setSelect")}}i.setSelect=_l;function xx(_){if(b[_].show)te&&Kf(st[_],Ur);else if(te&&gi(st[_],Ur),ge){let R=Ce?ot[0]:ot[_];R!=null&&ls(R,-10,-10,U,Ie)}}function Vs(_,S,R){wh(_,{min:S,max:R})}function ji(_,S,R,N){S.focus!=null&&Ex(_),S.show!=null&&b.forEach((G,J)=>{J>0&&(_==J||_==null)&&(G.show=S.show,xx(J),s==2?(Vs(G.facets[0].scale,null,null),Vs(G.facets[1].scale,null,null)):Vs(G.scale,null,null),On())}),R!==!1&&Cn("setSeries",_,S),N&&ta("setSeries",i,_,S)}i.setSeries=ji;function vx(_,S){gn(I[_],S)}function bx(_,S){_.fill=yt(_.fill||null),_.dir=bt(_.dir,-1),S=S??I.length,I.splice(S,0,_)}function Sx(_){_==null?I.length=0:I.splice(_,1)}i.addBand=bx,i.setBand=vx,i.delBand=Sx;function Mx(_,S){b[_].alpha=S,ge&&ot[_]!=null&&(ot[_].style.opacity=S),te&&st[_]&&(st[_].style.opacity=S)}let ps,zs,fr,qr={focus:!0};function Ex(_){if(_!=fr){let S=_==null,R=Be.alpha!=1;b.forEach((N,G)=>{if(s==1||G>0){let J=S||G==0||G==_;N._focus=S?null:J,R&&Mx(G,J?1:Be.alpha)}}),fr=_,R&&On()}}te&&je&&xt(P_,Re,_=>{de._lock||(Je(_),fr!=null&&ji(null,qr,!0,pn.setSeries))});function Qi(_,S,R){let N=E[S];R&&(_=_/Mt-(N.ori==1?rt:Ke));let G=U;N.ori==1&&(G=Ie,_=G-_),N.dir==-1&&(_=G-_);let J=N._min,le=N._max,pe=_/G,be=J+(le-J)*pe,De=N.distr;return De==3?ko(10,be):De==4?Sw(be,N.asinh):De==100?N.bwd(be):be}function Ax(_,S){let R=Qi(_,T,S);return Yi(R,e[0],on,an)}i.valToIdx=_=>Yi(_,e[0]),i.posToIdx=Ax,i.posToVal=Qi,i.valToPos=(_,S,R)=>E[S].ori==0?r(_,E[S],R?Y:U,R?w:0):o(_,E[S],R?he:Ie,R?x:0),i.setCursor=(_,S,R)=>{Ht=_.left,$t=_.top,pr(null,S,R)};function Np(_,S){Zt($r,Uo,Wt.left=_),Zt($r,rl,Wt.width=S)}function Pp(_,S){Zt($r,"top",Wt.top=_),Zt($r,ol,Wt.height=S)}let jo=L.ori==0?Np:Pp,Qo=L.ori==1?Np:Pp;function Tx(){if(te&&fe.live)for(let _=s==2?1:0;_<b.length;_++){if(_==0&&at)continue;let S=fe.values[_],R=0;for(let N in S)ze[_][R++].firstChild.nodeValue=S[N]}}function Ih(_,S){if(_!=null&&(_.idxs?_.idxs.forEach((R,N)=>{re[N]=R}):Tw(_.idx)||re.fill(_.idx),fe.idx=re[0]),te&&fe.live){for(let R=0;R<b.length;R++)(R>0||s==1&&!at)&&wx(R,re[R]);Tx()}me=!1,S!==!1&&Cn("setLegend")}i.setLegend=Ih;function wx(_,S){let R=b[_],N=_==0&&k==2?ni:e[_],G;at?G=R.values(i,_,S)??nt:(G=R.value(i,S==null?null:N[S],_,S),G=G==null?nt:{_:G}),fe.values[_]=G}function pr(_,S,R){Cp=Ht,Ip=$t,[Ht,$t]=de.move(i,Ht,$t),de.left=Ht,de.top=$t,ge&&(Xr&&ls(Xr,Mn(Ht),0,U,Ie),Yr&&ls(Yr,0,Mn($t),U,Ie));let N,G=on>an;ps=Bt,zs=null;let J=L.ori==0?U:Ie,le=L.ori==1?U:Ie;if(Ht<0||Qt==0||G){N=de.idx=null;for(let pe=0;pe<b.length;pe++){let be=ot[pe];be!=null&&ls(be,-10,-10,U,Ie)}je&&ji(null,qr,!0,_==null&&pn.setSeries),fe.live&&(re.fill(N),me=!0)}else{let pe,be,De;s==1&&(pe=L.ori==0?Ht:$t,be=Qi(pe,T),N=de.idx=Yi(be,e[0],on,an),De=z(e[0][N],L,J,0));let Fe=-10,Oe=-10,it=0,St=0,vt=!0,pt="",qe="";for(let Xe=s==2?1:0;Xe<b.length;Xe++){let Xt=b[Xe],tn=re[Xe],In=tn==null?null:s==1?e[Xe][tn]:e[Xe][1][tn],Dt=de.dataIdx(i,Xe,N,be),nn=Dt==null?null:s==1?e[Xe][Dt]:e[Xe][1][Dt];if(me=me||nn!=In||Dt!=tn,re[Xe]=Dt,Xe>0&&Xt.show){let ii=Dt==null?-10:Dt==N?De:z(s==1?e[0][Dt]:e[Xe][0][Dt],L,J,0),Wn=nn==null?-10:P(nn,s==1?E[Xt.scale]:E[Xt.facets[1].scale],le,0);if(je&&nn!=null){let xi=L.ori==1?Ht:$t,Pi=En(Be.dist(i,Xe,Dt,Wn,xi));if(Pi<ps){let es=Be.bias;if(es!=0){let si=Qi(xi,Xt.scale),vi=nn>=0?1:-1,Li=si>=0?1:-1;Li==vi&&(Li==1?es==1?nn>=si:nn<=si:es==1?nn<=si:nn>=si)&&(ps=Pi,zs=Xe)}else ps=Pi,zs=Xe}}if(me||Ce){let xi,Pi;L.ori==0?(xi=ii,Pi=Wn):(xi=Wn,Pi=ii);let es,si,vi,Li,ts,Xn,ri=!0,mr=ce.bbox;if(mr!=null){ri=!1;let Yn=mr(i,Xe);vi=Yn.left,Li=Yn.top,es=Yn.width,si=Yn.height}else vi=xi,Li=Pi,es=si=ce.size(i,Xe);if(Xn=ce.fill(i,Xe),ts=ce.stroke(i,Xe),Ce)Xe==zs&&ps<=Be.prox&&(Fe=vi,Oe=Li,it=es,St=si,vt=ri,pt=Xn,qe=ts);else{let Yn=ot[Xe];Yn!=null&&(zt[Xe]=vi,zn[Xe]=Li,k_(Yn,es,si,ri),O_(Yn,Xn,ts),ls(Yn,Ii(vi),Ii(Li),U,Ie))}}}}if(Ce){let Xe=Be.prox,Xt=fr==null?ps<=Xe:ps>Xe||zs!=fr;if(me||Xt){let tn=ot[0];tn!=null&&(zt[0]=Fe,zn[0]=Oe,k_(tn,it,St,vt),O_(tn,pt,qe),ls(tn,Ii(Fe),Ii(Oe),U,Ie))}}}if(Wt.show&&Gs)if(_!=null){let[pe,be]=pn.scales,[De,Fe]=pn.match,[Oe,it]=_.cursor.sync.scales,St=_.cursor.drag;if(wn=St._x,Rn=St._y,wn||Rn){let{left:vt,top:pt,width:qe,height:Xe}=_.select,Xt=_.scales[Oe].ori,tn=_.posToVal,In,Dt,nn,ii,Wn,xi=pe!=null&&De(pe,Oe),Pi=be!=null&&Fe(be,it);xi&&wn?(Xt==0?(In=vt,Dt=qe):(In=pt,Dt=Xe),nn=E[pe],ii=z(tn(In,Oe),nn,J,0),Wn=z(tn(In+Dt,Oe),nn,J,0),jo(Zi(ii,Wn),En(Wn-ii))):jo(0,J),Pi&&Rn?(Xt==1?(In=vt,Dt=qe):(In=pt,Dt=Xe),nn=E[be],ii=P(tn(In,it),nn,le,0),Wn=P(tn(In+Dt,it),nn,le,0),Qo(Zi(ii,Wn),En(Wn-ii))):Qo(0,le)}else Lh()}else{let pe=En(Cp-wp),be=En(Ip-Rp);if(L.ori==1){let it=pe;pe=be,be=it}wn=Dn.x&&pe>=Dn.dist,Rn=Dn.y&&be>=Dn.dist;let De=Dn.uni;De!=null?wn&&Rn&&(wn=pe>=De,Rn=be>=De,!wn&&!Rn&&(be>pe?Rn=!0:wn=!0)):Dn.x&&Dn.y&&(wn||Rn)&&(wn=Rn=!0);let Fe,Oe;wn&&(L.ori==0?(Fe=Zr,Oe=Ht):(Fe=Kr,Oe=$t),jo(Zi(Fe,Oe),En(Oe-Fe)),Rn||Qo(0,le)),Rn&&(L.ori==1?(Fe=Zr,Oe=Ht):(Fe=Kr,Oe=$t),Qo(Zi(Fe,Oe),En(Oe-Fe)),wn||jo(0,J)),!wn&&!Rn&&(jo(0,0),Qo(0,0))}if(Dn._x=wn,Dn._y=Rn,_==null){if(R){if(Hp!=null){let[pe,be]=pn.scales;pn.values[0]=pe!=null?Qi(L.ori==0?Ht:$t,pe):null,pn.values[1]=be!=null?Qi(L.ori==1?Ht:$t,be):null}ta(Gf,i,Ht,$t,U,Ie,N)}if(je){let pe=R&&pn.setSeries,be=Be.prox;fr==null?ps<=be&&ji(zs,qr,!0,pe):ps>be?ji(null,qr,!0,pe):zs!=fr&&ji(zs,qr,!0,pe)}}me&&(fe.idx=N,Ih()),S!==!1&&Cn("setCursor")}let Hs=null;Object.defineProperty(i,"rect",{get(){return Hs==null&&ea(!1),Hs}});function ea(_=!1){_?Hs=null:(Hs=g.getBoundingClientRect(),Cn("syncRect",Hs))}function Lp(_,S,R,N,G,J,le){de._lock||Gs&&_!=null&&_.movementX==0&&_.movementY==0||(Nh(_,S,R,N,G,J,le,!1,_!=null),_!=null?pr(null,!0,!0):pr(S,!0,!1))}function Nh(_,S,R,N,G,J,le,pe,be){if(Hs==null&&ea(!1),Je(_),_!=null)R=_.clientX-Hs.left,N=_.clientY-Hs.top;else{if(R<0||N<0){Ht=-10,$t=-10;return}let[De,Fe]=pn.scales,Oe=S.cursor.sync,[it,St]=Oe.values,[vt,pt]=Oe.scales,[qe,Xe]=pn.match,Xt=S.axes[0].side%2==1,tn=L.ori==0?U:Ie,In=L.ori==1?U:Ie,Dt=Xt?J:G,nn=Xt?G:J,ii=Xt?N:R,Wn=Xt?R:N;if(vt!=null?R=qe(De,vt)?a(it,E[De],tn,0):-10:R=tn*(ii/Dt),pt!=null?N=Xe(Fe,pt)?a(St,E[Fe],In,0):-10:N=In*(Wn/nn),L.ori==1){let xi=R;R=N,N=xi}}be&&(S==null||S.cursor.event.type==Gf)&&((R<=1||R>=U-1)&&(R=Dr(R,U)),(N<=1||N>=Ie-1)&&(N=Dr(N,Ie))),pe?(wp=R,Rp=N,[Zr,Kr]=de.move(i,R,N)):(Ht=R,$t=N)}let Ph={width:0,height:0,left:0,top:0};function Lh(){_l(Ph,!1)}let Dp,Fp,Up,Op;function Bp(_,S,R,N,G,J,le){Gs=!0,wn=Rn=Dn._x=Dn._y=!1,Nh(_,S,R,N,G,J,le,!0,!1),_!=null&&(xt(Vf,Yf,kp,!1),ta(I_,i,Zr,Kr,U,Ie,null));let{left:pe,top:be,width:De,height:Fe}=Wt;Dp=pe,Fp=be,Up=De,Op=Fe}function kp(_,S,R,N,G,J,le){Gs=Dn._x=Dn._y=!1,Nh(_,S,R,N,G,J,le,!1,!0);let{left:pe,top:be,width:De,height:Fe}=Wt,Oe=De>0||Fe>0,it=Dp!=pe||Fp!=be||Up!=De||Op!=Fe;if(Oe&&it&&_l(Wt),Dn.setScale&&Oe&&it){let St=pe,vt=De,pt=be,qe=Fe;if(L.ori==1&&(St=be,vt=Fe,pt=pe,qe=De),wn&&Vs(T,Qi(St,T),Qi(St+vt,T)),Rn)for(let Xe in E){let Xt=E[Xe];Xe!=T&&Xt.from==null&&Xt.min!=Bt&&Vs(Xe,Qi(pt+qe,Xe),Qi(pt,Xe))}Lh()}else de.lock&&(de._lock=!de._lock,pr(S,!0,_!=null));_!=null&&(_n(Vf,Yf),ta(Vf,i,Ht,$t,U,Ie,null))}function Rx(_,S,R,N,G,J,le){if(de._lock)return;Je(_);let pe=Gs;if(Gs){let be=!0,De=!0,Fe=10,Oe,it;L.ori==0?(Oe=wn,it=Rn):(Oe=Rn,it=wn),Oe&&it&&(be=Ht<=Fe||Ht>=U-Fe,De=$t<=Fe||$t>=Ie-Fe),Oe&&be&&(Ht=Ht<Zr?0:U),it&&De&&($t=$t<Kr?0:Ie),pr(null,!0,!0),Gs=!1}Ht=-10,$t=-10,re.fill(null),pr(null,!0,!0),pe&&(Gs=pe)}function Gp(_,S,R,N,G,J,le){de._lock||(Je(_),Jo(),Lh(),_!=null&&ta(L_,i,Ht,$t,U,Ie,null))}function Vp(){C.forEach(z1),F(i.width,i.height,!0)}Or(Ju,Bo,Vp);let Jr={};Jr.mousedown=Bp,Jr.mousemove=Lp,Jr.mouseup=kp,Jr.dblclick=Gp,Jr.setSeries=(_,S,R,N)=>{let G=pn.match[2];R=G(i,S,R),R!=-1&&ji(R,N,!0,!1)},ge&&(xt(I_,g,Bp),xt(Gf,g,Lp),xt(N_,g,_=>{Je(_),ea(!1)}),xt(P_,g,Rx),xt(L_,g,Gp),ep.add(i),i.syncRect=ea);let yl=i.hooks=n.hooks||{};function Cn(_,S,R){Hn?Nt.push([_,S,R]):_ in yl&&yl[_].forEach(N=>{N.call(null,i,S,R)})}(n.plugins||[]).forEach(_=>{for(let S in _.hooks)yl[S]=(yl[S]||[]).concat(_.hooks[S])});let zp=(_,S,R)=>R,pn=gn({key:null,setSeries:!1,filters:{pub:W_,sub:W_},scales:[T,b[1]?b[1].scale:null],match:[X_,X_,zp],values:[null,null]},de.sync);pn.match.length==2&&pn.match.push(zp),de.sync=pn;let Hp=pn.key,Dh=Vy(Hp);function ta(_,S,R,N,G,J,le){pn.filters.pub(_,S,R,N,G,J,le)&&Dh.pub(_,S,R,N,G,J,le)}Dh.sub(i);function Cx(_,S,R,N,G,J,le){pn.filters.sub(_,S,R,N,G,J,le)&&Jr[_](null,S,R,N,G,J,le)}i.pub=Cx;function Ix(){Dh.unsub(i),ep.delete(i),Tn.clear(),$f(Ju,Bo,Vp),l.remove(),Re?.remove(),Cn("destroy")}i.destroy=Ix;function Fh(){Cn("init",n,e),qo(e||n.data,!1),W[T]?wh(T,W[T]):Jo(),se=Wt.show&&(Wt.width>0||Wt.height>0),ne=me=!0,F(n.width,n.height)}return b.forEach(Vr),C.forEach(us),t?t instanceof HTMLElement?(t.appendChild(l),Fh()):t(i,Fh):Fh(),i}Un.assign=gn;Un.fmtNum=ap;Un.rangeNum=ju;Un.rangeLog=th;Un.rangeAsinh=rp;Un.orient=kr;Un.pxRatio=Mt;Un.join=Lw;Un.fmtDate=cp,Un.tzDate=Ww;Un.sync=Vy;{Un.addGap=T1,Un.clipGaps=sh;let n=Un.paths={points:Zy};n.linear=$y,n.stepped=C1,n.bars=I1,n.spline=P1}var lh=class{constructor(e,t){this.measure=e;this.looks=t;for(let[s,r,o]of il)this.toolBar.append(X("button",{type:"button",title:o,"data-tool":s,onclick:()=>e.setTool(s)},r));this.undo=X("button",{type:"button",disabled:!0,onclick:()=>{e.change({case:"undo",value:!0})}},"Undo");let i=X("button",{type:"button",onclick:()=>{e.change({case:"clear",value:!0})}},"Remove all");this.element.append(this.toolBar,X("div",{class:"grid"},this.undo,i),this.none,this.list,this.detail),e.onTool=s=>{for(let r of this.toolBar.querySelectorAll("button"))r.setAttribute("aria-pressed",String(r.dataset.tool===s))},e.onSelect=s=>{this.choose(s),this.onOpen()},e.onMade=s=>this.choose(s.id),e.setTool("read"),t.onChange((s,r)=>{r.has("unit")&&this.draw(!0)})}measure;looks;element=X("div",{class:"measure"});toolBar=X("div",{class:"tools",role:"group","aria-label":"Tools"});list=X("ul",{class:"objects"});detail=X("section",{class:"detail","aria-label":"Chosen object"});none=X("p",{class:"note"},"Nothing is measured yet. Choose a tool and touch the surface.");undo;measurements;materials=[];chosen="";shownKey="";onOpen=()=>{};setMaterials(e){this.materials=e}set(e){this.measurements=e,this.undo.disabled=e.undoable===0,this.draw(!1)}setEditable(e){this.element.toggleAttribute("data-readonly",!e);for(let t of this.toolBar.querySelectorAll("button"))t.disabled=!e&&t.dataset.tool!=="read"}choose(e){this.chosen=this.chosen===e?"":e,this.measure.select(this.chosen),this.draw(!0)}find(e){let t=this.measurements?.shapes.findIndex(i=>i.id===e)??-1;return t<0?null:[this.measurements.shapes[t],this.measurements.measured[t]]}draw(e){let{unit:t}=this.looks.value,i=this.measurements?.shapes??[];Vt(this.none,i.length===0),this.list.replaceChildren(...i.map((s,r)=>{let o=this.measurements.measured[r];return X("li",{},X("button",{type:"button","aria-pressed":String(s.id===this.chosen),"data-alarm":o?.alarm??"",onclick:()=>this.choose(s.id)},X("span",{},s.name||Uf(s.kind),X("small",{},Uf(s.kind))),X("b",{},Of(s,o,t))))})),this.drawDetail(e)}drawDetail(e){let t=this.find(this.chosen);if(!t){this.detail.replaceChildren(),this.shownKey="";return}let[i,s]=t,r=JSON.stringify([i.id,i.name,i.kind,i.text,i.parameters,i.alarmAboveCelsius,i.alarmBelowCelsius],(a,c)=>typeof c=="bigint"?String(c):c),o=X("div",{class:"values"},...this.values(i,s));!e&&r===this.shownKey&&this.detail.firstElementChild?this.detail.querySelector(".values").replaceWith(o):(this.shownKey=r,this.detail.replaceChildren(this.nameField(i),o,...this.parameters(i),this.actions(i))),this.drawProfile(i,s,o)}nameField(e){let t=X("input",{type:"text",value:e.name,maxLength:60,"aria-label":"Name",onchange:()=>{this.change(e,s=>{s.name=t.value})}}),i=X("input",{type:"text",value:e.text,maxLength:500,placeholder:"Remark","aria-label":"Remark",onchange:()=>{this.change(e,s=>{s.text=i.value})}});return X("div",{class:"names"},t,i)}values(e,t){let{unit:i}=this.looks.value;if(!t)return[];if(t.problem!=="")return[X("p",{class:"why"},t.problem)];let s=[],r=(c,l)=>{l&&(s.push([`${c} maximum`,Mi(l.maxCelsius,i)],[`${c} mean`,Mi(l.meanCelsius,i)],[`${c} minimum`,Mi(l.minCelsius,i)],[`${c} deviation`,xs(l.deviationK,i,2)]),l.sigmaK!==void 0&&s.push([`${c} uncertainty`,`± ${xs(l.sigmaK,i,2)}`]))};e.kind===2&&s.push(["area",t.areaM2<.1?`${(1e4*t.areaM2).toFixed(1)} cm²`:`${t.areaM2.toFixed(3)} m²`]),e.kind===1&&s.push(["length, straight",`${(1e3*t.lengthM).toFixed(1)} mm`],["along the surface",`${(1e3*t.surfaceLengthM).toFixed(1)} mm`]),e.kind===4&&s.push(["distance",`${(1e3*t.lengthM).toFixed(1)} mm`]),t.differenceK!==void 0&&s.push(["difference",xs(t.differenceK,i,2)]),t.differenceSigmaK!==void 0&&s.push(["uncertainty",`± ${xs(t.differenceSigmaK,i,2)}`]),r("object",t.object);let{quality:o,heatFlow:a}=t;return o&&s.push(["measured well",Oi(o.good)],["acceptable",Oi(o.acceptable)],["badly",Oi(o.bad)],["never",Oi(o.never)]),a&&a.measuredM2>0&&(s.push(["heat flow",`${a.totalW.toFixed(2)} W`],["by radiation",`${a.radiationW.toFixed(2)} W`],["by the air",`${a.convectionW.toFixed(2)} W`]),a.measuredM2<.98*t.areaM2&&s.push(["for the whole area",`${a.extrapolatedW.toFixed(2)} W`])),[...t.record?[X("div",{class:"record"},...Bf(t.record,i))]:[],X("dl",{class:"facts"},...s.map(([c,l])=>X("div",{},X("dt",{},c),X("dd",{},l)))),X("div",{class:"profile"})]}parameters(e){if(e.kind===4||e.kind===5)return[];let{unit:t}=this.looks.value,i=e.parameters,s=o=>{this.change(e,a=>{a.parameters??=sn(no),o(a.parameters)})},r=[];if(e.kind!==3){let o=io("Material",[["","the same at every angle"],...this.materials.map(a=>[a,a])],i?.material??"",a=>s(c=>{a===""?delete c.material:c.material=a}));r.push(o.element,Ys("Emissivity","",i?.emissivity??this.looks.value.emissivity,.01,a=>s(c=>{c.emissivity=a}),{min:.05,max:1}).element,Ys("Reflected",Jn(t),Number(jn(i?.reflectedCelsius??23,t).toFixed(1)),.5,a=>s(c=>{c.reflectedCelsius=ys(a,t)})).element)}return e.kind===2&&r.push(Ys("Air",Jn(t),Number(jn(i?.airCelsius??i?.reflectedCelsius??23,t).toFixed(1)),.5,o=>s(a=>{a.airCelsius=ys(o,t)})).element,Ys("Film coefficient","W/m²K",i?.filmCoefficientWM2k??8,.5,o=>s(a=>{a.filmCoefficientWM2k=o}),{min:0}).element),[X("details",{},X("summary",{},"Parameters and alarms"),...r,this.alarm(e,t,"above"),this.alarm(e,t,"below"))]}alarm(e,t,i){let s=e.kind===3,r=i==="above"?e.alarmAboveCelsius:e.alarmBelowCelsius,o=X("input",{type:"number",step:"0.5",value:r===void 0?"":String(Number((s?r:jn(r,t)).toFixed(2))),placeholder:"none",onchange:()=>{this.change(e,a=>{let c=o.value===""?void 0:s?Number(o.value):ys(Number(o.value),t),l=i==="above"?"alarmAboveCelsius":"alarmBelowCelsius";a[l]=c!==void 0&&Number.isFinite(c)?c:void 0})}});return X("label",{class:"field"},X("span",{},`Alarm ${i}`),X("span",{class:"with-unit"},o,X("span",{class:"unit"},s?"K":Jn(t))))}actions(e){let t=(this.measurements?.shapes??[]).filter(({id:r,kind:o})=>r!==e.id&&(o===0||o===1||o===2)),s=(e.kind===0||e.kind===1||e.kind===2)&&t.length>0?io("Compare with",[["","choose …"],...t.map(({id:r,name:o})=>[r,o])],"",r=>{let o=t.find(a=>a.id===r);o&&this.measure.put(sn(pa,{id:`${e.id}-${r}`,name:`${e.name} − ${o.name}`,kind:3,first:e.id,second:r}))}).element:null;return X("div",{class:"actions"},s,X("button",{type:"button",class:"order stop",onclick:()=>{this.measure.change({case:"remove",value:e.id})}},`Remove ${e.name}`))}async change(e,t){let i=Rm(pa,e);t(i),await this.measure.put(i)}drawProfile(e,t,i){let s=i.querySelector(".profile");if(!s||e.kind!==1||!t||t.profile.length<2)return;let{unit:r}=this.looks.value,{profile:o}=t,a=o.map(({alongM:h})=>1e3*h),c=o.map(({objectCelsius:h})=>h===void 0?null:jn(h,r)),l={stroke:"#a9b8c8",grid:{stroke:"#2b3747"},ticks:{stroke:"#2b3747"}};new Un({width:Math.max(240,this.detail.clientWidth-4),height:190,legend:{show:!1},scales:{x:{time:!1}},axes:[{...l,label:"mm along the surface",labelSize:18,size:34},{...l,size:52,label:Jn(r),labelSize:16}],series:[{},{stroke:"#ffb14c",width:2,spanGaps:!1,points:{show:!1}}],cursor:{y:!1,points:{size:9}},hooks:{setCursor:[h=>{let u=h.cursor.idx;this.measure.mark(u==null||h.cursor.left<0?null:Fs(o[u]?.point))}]}},[a,c],s)}};function Qy(n){let e=Math.max(0,Math.round(n));return`${Math.floor(e/60)}:${String(e%60).padStart(2,"0")}`}var ex=["0.25","0.5","1","2","4","8"],ch=class{constructor(e){this.connection=e;this.slider=X("input",{type:"range",min:"0",max:"1",step:"0.01",value:"0","aria-label":"Time of the recording"}),this.slider.addEventListener("input",()=>{this.dragging=!0}),this.slider.addEventListener("change",()=>{this.dragging=!1,this.send({positionS:Number(this.slider.value)})}),this.play=X("button",{type:"button",class:"primary",title:"Play or pause (space)",onclick:()=>this.toggle()},"Play"),this.speed=X("select",{"aria-label":"Speed"},...ex.map(t=>X("option",{value:t},`${t}×`))),this.speed.value="1",this.speed.addEventListener("change",()=>{this.send({speed:Number(this.speed.value)})}),this.element=X("div",{class:"playback",role:"group","aria-label":"Playback",hidden:!0},this.play,this.slider,this.time,this.speed)}connection;element;slider;play;time=X("span",{class:"time"});speed;playing=!1;dragging=!1;toggle(){this.element.hidden||this.send({playing:!this.playing})}set(e){this.element.hidden=!1,this.playing=e.playing,Pt(this.play,e.playing?"Pause":"Play"),this.slider.max=String(e.durationS),this.dragging||(this.slider.value=String(e.positionS)),Pt(this.time,e.seeking?"…":`${Qy(e.positionS)} / ${Qy(e.durationS)}`),this.speed.value=ex.find(t=>Number(t)===e.speed)??"1"}async send(e){await this.connection.ask({case:"playback",value:sn(Sg,e)})}};var uh=class{values;min;max;constructor(e){this.values=Float32Array.from(e.radiance),this.min=e.minCelsius,this.max=e.maxCelsius}ofCelsius(e){let t=(e-this.min)/(this.max-this.min)*(this.values.length-1);if(!(t>=0)||t>this.values.length-1)return NaN;let i=Math.min(Math.floor(t),this.values.length-2);return this.values[i]+(t-i)*(this.values[i+1]-this.values[i])}toCelsius(e){let t=this.values;if(!(e>=t[0])||e>t[t.length-1])return NaN;let i=0,s=t.length-1;for(;s-i>1;){let o=i+s>>1;t[o]<=e?i=o:s=o}let r=(e-t[i])/(t[s]-t[i]);return this.min+(i+r)/(t.length-1)*(this.max-this.min)}objectCelsius(e,t,i){return this.toCelsius((this.ofCelsius(e)-(1-t)*this.ofCelsius(i))/t)}};function tx(n){let e=new Float32Array(91).fill(1);return n&&e.set(n.byAngle.slice(0,91)),e}var nx={type:"change"},_p={type:"start"},sx={type:"end"},hh=new tr,ix=new ci,H1=Math.cos(70*bf.DEG2RAD),An=new H,ti=2*Math.PI,Et={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},gp=1e-6,dh=class extends Va{constructor(e,t=null){super(e,t),this.state=Et.NONE,this.target=new H,this.cursor=new H,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:or.ROTATE,MIDDLE:or.DOLLY,RIGHT:or.PAN},this.touches={ONE:ar.ROTATE,TWO:ar.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new H,this._lastQuaternion=new Kn,this._lastTargetPosition=new H,this._quat=new Kn().setFromUnitVectors(e.up,new H(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Ro,this._sphericalDelta=new Ro,this._scale=1,this._panOffset=new H,this._rotateStart=new $e,this._rotateEnd=new $e,this._rotateDelta=new $e,this._panStart=new $e,this._panEnd=new $e,this._panDelta=new $e,this._dollyStart=new $e,this._dollyEnd=new $e,this._dollyDelta=new $e,this._dollyDirection=new H,this._mouse=new $e,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=X1.bind(this),this._onPointerDown=W1.bind(this),this._onPointerUp=Y1.bind(this),this._onContextMenu=Q1.bind(this),this._onMouseWheel=$1.bind(this),this._onKeyDown=q1.bind(this),this._onTouchStart=J1.bind(this),this._onTouchMove=j1.bind(this),this._onMouseDown=Z1.bind(this),this._onMouseMove=K1.bind(this),this._interceptControlDown=eR.bind(this),this._interceptControlUp=tR.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=Et.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(nx),this.update(),this.state=Et.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;An.copy(t).sub(this.target),An.applyQuaternion(this._quat),this._spherical.setFromVector3(An),this.autoRotate&&this.state===Et.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let i=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(i)&&isFinite(s)&&(i<-Math.PI?i+=ti:i>Math.PI&&(i-=ti),s<-Math.PI?s+=ti:s>Math.PI&&(s-=ti),i<=s?this._spherical.theta=Math.max(i,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(i+s)/2?Math.max(i,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(An.setFromSpherical(this._spherical),An.applyQuaternion(this._quatInverse),t.copy(this.target).add(An),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=An.length();o=this._clampDistance(a*this._scale);let c=a-o;this.object.position.addScaledVector(this._dollyDirection,c),this.object.updateMatrixWorld(),r=!!c}else if(this.object.isOrthographicCamera){let a=new H(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let c=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=c!==this.object.zoom;let l=new H(this._mouse.x,this._mouse.y,0);l.unproject(this.object),this.object.position.sub(l).add(a),this.object.updateMatrixWorld(),o=An.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(hh.origin.copy(this.object.position),hh.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(hh.direction))<H1?this.object.lookAt(this.target):(ix.setFromNormalAndCoplanarPoint(this.object.up,this.target),hh.intersectPlane(ix,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>gp||8*(1-this._lastQuaternion.dot(this.object.quaternion))>gp||this._lastTargetPosition.distanceToSquared(this.target)>gp?(this.dispatchEvent(nx),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?ti/60*this.autoRotateSpeed*e:ti/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){An.setFromMatrixColumn(t,0),An.multiplyScalar(-e),this._panOffset.add(An)}_panUp(e,t){this.screenSpacePanning===!0?An.setFromMatrixColumn(t,1):(An.setFromMatrixColumn(t,0),An.crossVectors(this.object.up,An)),An.multiplyScalar(e),this._panOffset.add(An)}_pan(e,t){let i=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;An.copy(s).sub(this.target);let r=An.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/i.clientHeight,this.object.matrix),this._panUp(2*t*r/i.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/i.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/i.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let i=this.domElement.getBoundingClientRect(),s=e-i.left,r=t-i.top,o=i.width,a=i.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ti*this._rotateDelta.x/t.clientHeight),this._rotateUp(ti*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(ti*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-ti*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(ti*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-ti*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(i,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(i,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let i=this._getSecondPointerPosition(e),s=.5*(e.pageX+i.x),r=.5*(e.pageY+i.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ti*this._rotateDelta.x/t.clientHeight),this._rotateUp(ti*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(i,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new $e,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,i={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:i.deltaY*=16;break;case 2:i.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(i.deltaY*=10),i}};function W1(n){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(n.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(n)&&(this._addPointer(n),n.pointerType==="touch"?this._onTouchStart(n):this._onMouseDown(n),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function X1(n){this.enabled!==!1&&(n.pointerType==="touch"?this._onTouchMove(n):this._onMouseMove(n))}function Y1(n){switch(this._removePointer(n),this._pointers.length){case 0:this.domElement.releasePointerCapture(n.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(sx),this.state=Et.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function Z1(n){let e;switch(n.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case or.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(n),this.state=Et.DOLLY;break;case or.ROTATE:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=Et.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=Et.ROTATE}break;case or.PAN:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=Et.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=Et.PAN}break;default:this.state=Et.NONE}this.state!==Et.NONE&&this.dispatchEvent(_p)}function K1(n){switch(this.state){case Et.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(n);break;case Et.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(n);break;case Et.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(n);break}}function $1(n){this.enabled===!1||this.enableZoom===!1||this.state!==Et.NONE||(n.preventDefault(),this.dispatchEvent(_p),this._handleMouseWheel(this._customWheelEvent(n)),this.dispatchEvent(sx))}function q1(n){this.enabled!==!1&&this._handleKeyDown(n)}function J1(n){switch(this._trackPointer(n),this._pointers.length){case 1:switch(this.touches.ONE){case ar.ROTATE:if(this.enableRotate===!1){this.state=Et.NONE;break}this._handleTouchStartRotate(n),this.state=Et.TOUCH_ROTATE;break;case ar.PAN:if(this.enablePan===!1){this.state=Et.NONE;break}this._handleTouchStartPan(n),this.state=Et.TOUCH_PAN;break;default:this.state=Et.NONE}break;case 2:switch(this.touches.TWO){case ar.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(n),this.state=Et.TOUCH_DOLLY_PAN;break;case ar.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(n),this.state=Et.TOUCH_DOLLY_ROTATE;break;default:this.state=Et.NONE}break;default:this.state=Et.NONE}this.state!==Et.NONE&&this.dispatchEvent(_p)}function j1(n){switch(this._trackPointer(n),this.state){case Et.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(n),this.update();break;case Et.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(n),this.update();break;case Et.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(n),this.update();break;case Et.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(n),this.update();break;default:this.state=Et.NONE}}function Q1(n){this.enabled!==!1&&n.preventDefault()}function eR(n){n.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function tR(n){n.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var ph=8,nR=`
in vec2 temperature;
in vec4 conditions;
in vec4 details;
uniform sampler2D radiance;
uniform sampler2D ratios;
uniform vec2 radianceRange;
uniform int radianceSize;
uniform bool interpret;
uniform float emissivity;
uniform float reflectedRadiance;
out vec3 vNormal;
out vec3 vPosition;
out float vCelsius;
out float vMeasured;
out float vAge;
out float vAgeKnown;
out float vSigma;
out float vSigmaKnown;
flat out int vClasses;

float tableAt(sampler2D table, int i) { return texelFetch(table, ivec2(i, 0), 0).r; }

float radianceOf(float celsius) {
  float at = clamp((celsius - radianceRange.x) / (radianceRange.y - radianceRange.x), 0.0, 1.0) * float(radianceSize - 1);
  int first = min(int(at), radianceSize - 2);
  return mix(tableAt(radiance, first), tableAt(radiance, first + 1), at - float(first));
}

float celsiusOf(float value) {
  int low = 0;
  int high = radianceSize - 1;
  for (int i = 0; i < 12; ++i) {
    int middle = (low + high) / 2;
    if (tableAt(radiance, middle) <= value) low = middle; else high = middle;
  }
  high = low + 1;
  float from = tableAt(radiance, low);
  float fraction = (value - from) / (tableAt(radiance, high) - from);
  return mix(radianceRange.x, radianceRange.y, (float(low) + fraction) / float(radianceSize - 1));
}

void main() {
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  vPosition = view.xyz;
  vNormal = normalMatrix * normal;
  vMeasured = temperature.x > 0.0 ? 1.0 : 0.0;
  float celsius = -100.0 + 0.025 * (temperature.x - 1.0);
  if (interpret && vMeasured > 0.5) {
    float degrees = conditions.y >= 255.0 ? 0.0 : 0.5 * conditions.y;
    int whole = min(int(degrees), 89);
    float e = min(1.0, emissivity * mix(tableAt(ratios, whole), tableAt(ratios, whole + 1), degrees - float(whole)));
    float emitted = (radianceOf(celsius) - (1.0 - e) * reflectedRadiance) / e;
    if (emitted < tableAt(radiance, 0)) vMeasured = 0.0; else celsius = celsiusOf(emitted);
  }
  vCelsius = celsius;
  vClasses = int(conditions.x + 0.5);
  vAgeKnown = conditions.w >= 255.0 ? 0.0 : 1.0;
  vAge = 1024.0 * (conditions.w / 254.0) * (conditions.w / 254.0);
  vSigmaKnown = details.x > 0.0 ? 1.0 : 0.0;
  // The upper bits of a single-precision number: four of the exponent, four of the mantissa, beginning at 2^-7.
  float code = details.x - 1.0;
  float step16 = floor(code / 16.0);
  vSigma = exp2(step16 - 7.0) * (1.0 + (code - 16.0 * step16) / 16.0);
  gl_Position = projectionMatrix * view;
}`,iR=`
precision highp float;
uniform int layer;
uniform sampler2D palette;
uniform sampler2D inferno;
uniform vec2 span;
uniform float isotherms[${ph}];
uniform int isothermCount;
uniform bool shading;
uniform float largestAge;
uniform float largestSigma;
uniform vec2 alarm;
uniform vec3 goodColour, acceptableColour, badColour, uncheckedColour, neverColour, missingColour, onlyBadColour;
in vec3 vNormal;
in vec3 vPosition;
in float vCelsius;
in float vMeasured;
in float vAge;
in float vAgeKnown;
in float vSigma;
in float vSigmaKnown;
flat in int vClasses;
out vec4 colour;

vec3 classColour(int condition, vec3 unknown) {
  return condition == 3 ? goodColour : condition == 2 ? acceptableColour : condition == 1 ? badColour : unknown;
}

/// A hatching that stands for "never measured": it cannot be taken for a temperature.
vec3 never() {
  float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 6.0 ? 1.0 : 0.0;
  return mix(vec3(0.145, 0.165, 0.2), vec3(0.205, 0.23, 0.275), stripe);
}

vec3 coverage() {
  int d = vClasses & 3;
  int a = (vClasses >> 2) & 3;
  int m = (vClasses >> 4) & 3;
  if (d == 0 || a == 0) return missingColour;
  int worst = min(d, a);
  if (m != 0) worst = min(worst, m);
  return worst == 3 ? vec3(0.73, 0.755, 0.77) : worst == 2 ? vec3(0.47, 0.55, 0.59) : onlyBadColour;
}

vec3 along(float value, float largest) {
  return texture(inferno, vec2(clamp(1.0 - value / largest, 0.002, 0.998), 0.5)).rgb;
}

void main() {
  bool measured = vMeasured > 0.999;
  vec3 base;
  float light = 1.0;
  if (layer == 0) {
    float fraction = (vCelsius - span.x) / (span.y - span.x);
    base = measured ? texture(palette, vec2(clamp(fraction, 0.002, 0.998), 0.5)).rgb : never();
    if (measured && (vCelsius > alarm.y || vCelsius < alarm.x)) {
      float pulse = mod(gl_FragCoord.x - gl_FragCoord.y, 10.0) < 5.0 ? 1.0 : 0.0;
      base = mix(base, vCelsius > alarm.y ? vec3(1.0, 0.1, 0.1) : vec3(0.1, 0.5, 1.0), 0.35 + 0.4 * pulse);
    }
  } else if (layer == 1) base = coverage();
  else if (layer == 2) base = classColour(vClasses & 3, neverColour);
  else if (layer == 3) base = classColour((vClasses >> 2) & 3, neverColour);
  else if (layer == 4) base = classColour((vClasses >> 4) & 3, (vClasses & 3) == 0 ? neverColour : uncheckedColour);
  else if (layer == 5) base = classColour((vClasses >> 6) & 3, (vClasses & 3) == 0 ? neverColour : uncheckedColour);
  else if (layer == 6) base = !measured ? never() : vAgeKnown > 0.999 ? along(vAge, largestAge) : uncheckedColour;
  else if (layer == 7) base = !measured ? never() : vSigmaKnown > 0.999 ? along(vSigma, largestSigma) : uncheckedColour;
  else base = vec3(0.88, 0.886, 0.9);
  if (layer == 0 && measured) {
    float slope = max(fwidth(vCelsius), 1e-4);
    for (int i = 0; i < isothermCount; ++i) {
      float off = abs(vCelsius - isotherms[i]) / slope;
      base = mix(vec3(0.06, 0.07, 0.086), base, smoothstep(1.3, 2.2, off));
      base = mix(vec3(1.0), base, smoothstep(0.6, 1.2, off));
    }
  }
  if (shading || layer == 8) {
    vec3 n = normalize(vNormal);
    float facing = abs(dot(n, normalize(-vPosition)));
    light = layer == 8 ? 0.25 + 0.75 * facing : 0.62 + 0.38 * facing;
  }
  colour = vec4(base * light, 1.0);
}`;function rx(n){let e=new Uint8Array(1024);for(let i=0;i<256;++i)e.set(n.subarray(3*i,3*i+3),4*i),e[4*i+3]=255;let t=new Tr(e,256,1);return t.minFilter=t.magFilter=Fn,t.needsUpdate=!0,t}function fh(n){let e=new Tr(n,n.length,1,Wa,mi);return e.needsUpdate=!0,e}var mh=class{material;palettes=new Map;radiance=null;materials=[];constructor(){let e=rx(Uint8Array.from({length:768},(i,s)=>Math.floor(s/3))),t=i=>{let s=new _t().setStyle(i,Ar);return new H(s.r,s.g,s.b)};this.material=new wi({glslVersion:Ja,vertexShader:nR,fragmentShader:iR,side:Ri,uniforms:{layer:{value:0},palette:{value:e},inferno:{value:e},span:{value:new $e(0,1)},isotherms:{value:new Array(ph).fill(0)},isothermCount:{value:0},shading:{value:!0},largestAge:{value:60},largestSigma:{value:2},alarm:{value:new $e(-1e9,1e9)},radiance:{value:fh(new Float32Array([0,1]))},radianceRange:{value:new $e(-100,1500)},radianceSize:{value:2},ratios:{value:fh(new Float32Array(91).fill(1))},interpret:{value:!1},emissivity:{value:1},reflectedRadiance:{value:0},goodColour:{value:t(Ei.good)},acceptableColour:{value:t(Ei.acceptable)},badColour:{value:t(Ei.bad)},uncheckedColour:{value:t(Ei.unchecked)},neverColour:{value:t(Ei.never)},missingColour:{value:t(Ei.missing)},onlyBadColour:{value:t(Ei.onlyBad)}}})}setTables(e,t,i){for(let{name:r,colours:o}of e)this.palettes.set(r,rx(o));this.radiance=t,this.materials=i;let s=this.material.uniforms;s.radiance.value=fh(t.values),s.radianceRange.value.set(t.min,t.max),s.radianceSize.value=t.values.length,s.inferno.value=this.palettes.get("inferno")??s.inferno.value}apply(e){let t=this.material.uniforms;t.layer.value=bs.findIndex(([i])=>i===e.layer),t.palette.value=this.palettes.get(e.palette)??t.palette.value,t.isothermCount.value=Math.min(ph,e.isotherms.length),t.isotherms.value=Array.from({length:ph},(i,s)=>e.isotherms[s]??0),t.shading.value=e.shading,t.interpret.value=e.interpret&&(e.emissivity<1||e.material!==""),t.emissivity.value=e.emissivity,t.reflectedRadiance.value=this.radiance?.ofCelsius(e.reflected_celsius)??0,t.ratios.value=fh(tx(this.materials.find(({name:i})=>i===e.material)))}setSpan(e,t){this.material.uniforms.span.value.set(e,t)}setLargest(e,t){this.material.uniforms.largestAge.value=e,this.material.uniforms.largestSigma.value=t}setAlarm(e,t){this.material.uniforms.alarm.value.set(e??-1e9,t??1e9)}};function ox(n){return`${n.map}/${n.x}/${n.y}/${n.z}`}function hl(n){return new Ft().compose(new H(n.x,n.y,n.z),new Kn(n.qx,n.qy,n.qz,n.qw),new H(1,1,1))}var gh=class{constructor(e){this.material=e;this.worker.addEventListener("message",t=>this.take(t.data))}material;root=new ui;worker=new Worker("decode.js",{type:"module"});mapRoots=[];shown=new Map;waiting=new Map;early=new Map;model=0n;triangles=0;spanShown=null;onChange=()=>{};onFirst=()=>{};latencies_ms=[];held(){return{model:this.model,groups:[...this.shown.values()].map(({key:e,version:t})=>({key:e,version:t}))}}get groups(){return this.shown.size}begin(e){if(e!==this.model){this.model=e;for(let t of[...this.shown.keys()])this.remove(t);this.waiting.clear(),this.early.clear(),this.onChange()}}setMaps(e){e.maps.forEach((t,i)=>{let s=this.rootOf(i);t.TWorldMap&&(s.matrix.copy(hl(t.TWorldMap)),s.matrixWorldNeedsUpdate=!0),s.visible=t.joined||e.active===i})}mapMatrix(e){return this.rootOf(e).matrix}add(e){let t=ox(e.key);if(e.vertexCount===0){this.waiting.delete(t),this.remove(t),this.onChange();return}this.waiting.set(t,e),this.post({kind:"group",group:{id:t,version:e.version,vertexCount:e.vertexCount,indexCount:e.indexCount,vertices:e.vertices,indices:e.indices}})}addDetails(e){this.post({kind:"details",details:{id:ox(e.key),version:e.version,vertexCount:e.vertexCount,details:e.details}})}span(){return this.spanShown??=this.spanOfAll(),this.spanShown}spanOfAll(){let e=[];for(let{measured:i}of this.shown.values())e.push(...i);if(e.length===0)return null;e.sort((i,s)=>i-s);let t=i=>-100+.025*(e[Math.round(i*(e.length-1))]-1);return[t(.01),t(.99)]}post(e){this.worker.postMessage(e)}rootOf(e){let t=this.mapRoots[e];return t||(t=new ui,t.matrixAutoUpdate=!1,this.mapRoots[e]=t,this.root.add(t)),t}take(e){e.kind==="group"?this.show(e.group):e.kind==="details"&&this.detail(e.details)}show(e){let t=this.waiting.get(e.id);if(!t||t.version!==e.version)return;this.waiting.delete(e.id);let i=this.shown.size===0;this.remove(e.id);let s=new Ln;s.setAttribute("position",new xn(e.positions,3)),s.setAttribute("normal",new xn(e.normals,4,!0)),s.setAttribute("temperature",new xn(e.temperatures,2)),s.setAttribute("conditions",new xn(e.conditions,4)),s.setIndex(new xn(e.indices,1));let r=32767.5;s.boundingSphere=new Is(new H(r,r,r),r*Math.sqrt(3));let o=new di(s,this.material);o.matrixAutoUpdate=!1;let a=t.scale;o.matrix.makeScale(a,a,a).setPosition(t.origin.x,t.origin.y,t.origin.z),this.rootOf(t.key.map).add(o);let c=[],l=2*Math.max(1,Math.floor(e.temperatures.length/2/50));for(let u=0;u<e.temperatures.length;u+=l)e.temperatures[u]>0&&c.push(e.temperatures[u]);this.spanShown=null,this.shown.set(e.id,{key:t.key,version:t.version,mesh:o,measured:c}),this.triangles+=e.indices.length/3;let h=this.early.get(e.id);h&&this.detail(h),t.version===1&&t.changedTimeNs>0n&&this.latencies_ms.length<5e3&&this.latencies_ms.push(Date.now()-Number(t.changedTimeNs/1000000n)),i&&this.onFirst(),this.onChange()}detail(e){let t=this.shown.get(e.id);if(t?.version!==e.version){this.early.set(e.id,e);return}this.early.delete(e.id),t.mesh.geometry.setAttribute("details",new xn(e.details,4)),this.onChange()}remove(e){let t=this.shown.get(e);t&&(this.triangles-=(t.mesh.geometry.index?.count??0)/3,t.mesh.removeFromParent(),t.mesh.geometry.dispose(),this.shown.delete(e),this.spanShown=null)}};var sR=new H(0,-.22,-.55),rR=new H(0,0,.65);function Yo(n,e,t,i){let s=n?.fx??1,r=n?.fy??1,o=n?.cx??0,a=n?.cy??0,c=(b,C)=>new H(e*(b-o)/s,e*(C-a)/r,e),l=n?.width??0,h=n?.height??0,u=[c(0,0),c(l,0),c(l,h),c(0,h)],d=new H,f=new H().addVectors(u[0],u[1]).multiplyScalar(.5);f.y-=.06*e;let g=[d,u[0],d,u[1],d,u[2],d,u[3],u[0],u[1],u[1],u[2],u[2],u[3],u[3],u[0],u[0],f,f,u[1]],v=new Ln().setFromPoints(g),p=i?new Ua({color:t,dashSize:.02,gapSize:.015}):new ss({color:t}),m=new To(v,p);return i&&m.computeLineDistances(),m.matrixAutoUpdate=!1,m.visible=!1,m.frustumCulled=!1,m}var oR=80,_h=class{constructor(e,t){this.canvas=e;this.looks=t;this.renderer=new zu({canvas:e,antialias:!0,powerPreference:"high-performance",preserveDrawingBuffer:!0}),this.renderer.setClearColor(724499),this.surface=new gh(this.surfaceMaterial.material),this.surface.onChange=()=>this.invalidate(),this.look=t.value,this.camera.up.set(0,-1,0),this.camera.position.set(0,-.4,-1.2),this.controls=new dh(this.camera,e),this.controls.enableDamping=!0,this.controls.dampingFactor=.12,this.controls.zoomToCursor=!0,this.controls.minDistance=.02,this.controls.addEventListener("start",()=>t.set({follow:!1})),this.controls.addEventListener("change",()=>{this.invalidate(),this.onMoved()}),this.scene.add(this.surface.root,this.path,this.volume,this.depth,this.thermal,this.next,this.arrow,this.overlay),this.arrow.visible=!1,this.volume.visible=!1,new ResizeObserver(()=>this.resize()).observe(e.parentElement),this.resize(),t.onChange(i=>{this.look=i,this.surfaceMaterial.apply(i),this.arrange()}),this.renderer.setAnimationLoop(i=>this.frame(i))}canvas;looks;surface;surfaceMaterial=new mh;scene=new wa;camera=new Zn(50,1,.01,100);controls;overlay=new ui;renderer;path=new ui;volume=new To(new Ln,new ss({color:3819094}));depth=Yo(void 0,.2,5030655,!1);thermal=Yo(void 0,.2,16751941,!1);next=Yo(void 0,.16,8257458,!0);arrow=new Ga(new H(0,0,1),new H,.1,8257458,.05,.03);T_thermal_depth;rigMatrix=new Ft;hasRig=!1;isLost=!1;nextPose;scan;needsFrame=!0;look;eye=new H;target=new H;lastFrame=0;framed=!1;frameTimes=[];drawnAt;restUntil=0;onMoved=()=>{};onFrame=()=>{};invalidate(){this.needsFrame=!0}setScan(e){let t=e.model!==this.scan?.model;if(this.scan=e,this.surface.begin(e.model),t&&(this.hasRig=!1,this.framed=!1,this.path.clear(),this.nextPose=void 0),this.T_thermal_depth=e.TThermalDepth,this.scene.remove(this.depth,this.thermal,this.next),this.depth=Yo(e.depth,.22,5030655,!1),this.thermal=Yo(e.thermal,.2,16751941,!1),this.next=Yo(e.depth,.18,8257458,!0),this.scene.add(this.depth,this.thermal,this.next),e.volumeMin&&e.volumeMax){let i=new H(e.volumeMin.x,e.volumeMin.y,e.volumeMin.z),s=new H(e.volumeMax.x,e.volumeMax.y,e.volumeMax.z),r=new H().subVectors(s,i);this.volume.geometry.dispose(),this.volume.geometry=new Da(new nr(r.x,r.y,r.z)),this.volume.position.addVectors(i,s).multiplyScalar(.5),!this.framed&&!this.hasRig&&this.home()}this.arrange()}setPose(e){this.isLost=e.tracking===3||e.tracking===0,e.TMapDepth&&(this.rigMatrix=this.surface.mapMatrix(e.map).clone().multiply(hl(e.TMapDepth)),this.hasRig||this.jumpToRig(),this.hasRig=!0),this.arrange()}setPath(e){this.path.clear();for(let t of e.parts){let i=new Ln;i.setAttribute("position",new xn(Float32Array.from(t.positions),3));let s=new Rr(i,new ss({color:9417945,transparent:!0,opacity:.8}));s.matrixAutoUpdate=!1,s.matrix.copy(this.surface.mapMatrix(t.map)),s.frustumCulled=!1,this.path.add(s)}this.invalidate()}setNext(e){this.nextPose=e,this.arrange()}home(){if(!this.scan?.volumeMin||!this.scan.volumeMax)return;let{volumeMin:e,volumeMax:t}=this.scan;this.target.set((e.x+t.x)/2,(e.y+t.y)/2,(e.z+t.z)/2);let i=Math.max(t.x-e.x,t.y-e.y,t.z-e.z);this.eye.set(this.target.x+.35*i,this.target.y-.45*i,this.target.z-1.45*i),this.camera.position.copy(this.eye),this.controls.target.copy(this.target),this.framed=!0,this.looks.set({follow:!1}),this.invalidate()}nudge(e,t,i){this.looks.set({follow:!1});let s=new H().subVectors(this.camera.position,this.controls.target),r=this.camera.up.clone().normalize();s.applyAxisAngle(r,e);let o=new H().crossVectors(r,s).normalize(),a=s.clone().applyAxisAngle(o,t);Math.abs(a.clone().normalize().dot(r))<.995&&s.copy(a),s.multiplyScalar(i),this.camera.position.addVectors(this.controls.target,s),this.invalidate()}eyeInWorld(){let{x:e,y:t,z:i}=this.look.follow&&this.hasRig?new H().setFromMatrixPosition(this.rigMatrix):this.camera.position;return{x:e,y:t,z:i}}get drawCalls(){return this.renderer.info.render.calls}rayAt(e,t){let i=this.canvas.getBoundingClientRect(),s=new ka;return s.setFromCamera(new $e(2*(e-i.left)/i.width-1,1-2*(t-i.top)/i.height),this.camera),s.ray}project(e){let t=e.clone().project(this.camera);if(t.z>1||t.z<-1)return null;let i=this.canvas.getBoundingClientRect();return{x:i.left+(t.x+1)/2*i.width,y:i.top+(1-t.y)/2*i.height}}arrange(){let{showCameras:e,showVolume:t,showPath:i,showNext:s}=this.look;this.depth.visible=e&&this.hasRig&&this.scan?.depth!==void 0,this.depth.matrix.copy(this.rigMatrix),this.depth.matrixWorldNeedsUpdate=!0,this.depth.material.color.set(this.isLost?16735324:5030655),this.thermal.visible=e&&this.hasRig&&this.scan?.thermal!==void 0&&this.T_thermal_depth!==void 0,this.T_thermal_depth&&(this.thermal.matrix.copy(this.rigMatrix).multiply(hl(this.T_thermal_depth).invert()),this.thermal.matrixWorldNeedsUpdate=!0),this.volume.visible=t&&this.scan?.volumeMin!==void 0,this.path.visible=i;let r=s&&this.nextPose!==void 0&&this.hasRig;if(this.next.visible=r&&this.scan?.depth!==void 0,this.arrow.visible=r,r){this.next.matrix.copy(hl(this.nextPose)),this.next.matrixWorldNeedsUpdate=!0;let o=new H().setFromMatrixPosition(this.rigMatrix),a=new H(this.nextPose.x,this.nextPose.y,this.nextPose.z).sub(o),c=a.length();this.arrow.visible=c>.03,this.arrow.position.copy(o),this.arrow.setDirection(a.normalize()),this.arrow.setLength(c,Math.min(.06,.4*c),Math.min(.035,.2*c))}this.invalidate()}followTargets(){this.eye.copy(sR).applyMatrix4(this.rigMatrix),this.target.copy(rR).applyMatrix4(this.rigMatrix)}jumpToRig(){this.followTargets(),this.look.follow&&(this.camera.position.copy(this.eye),this.controls.target.copy(this.target))}frame(e){let t=Math.min(.1,(e-this.lastFrame)/1e3);if(this.lastFrame=e,this.look.follow&&this.hasRig){this.followTargets();let s=1-Math.exp(-t/.35);(this.camera.position.distanceTo(this.eye)>1e-4||this.controls.target.distanceTo(this.target)>1e-4)&&(this.camera.position.lerp(this.eye,s),this.controls.target.lerp(this.target,s),this.needsFrame=!0)}if(this.controls.update(),this.drawnAt!==void 0&&e-this.drawnAt>oR&&(this.restUntil=e+(e-this.drawnAt)),this.drawnAt=void 0,!this.needsFrame||e<this.restUntil)return;this.needsFrame=!1,this.drawnAt=e;let i=performance.now();this.renderer.render(this.scene,this.camera),this.frameTimes.push(performance.now()-i),this.frameTimes.length>120&&this.frameTimes.shift(),this.onFrame()}resize(){let e=this.canvas.parentElement.getBoundingClientRect();this.renderer.setPixelRatio(Math.min(2,devicePixelRatio)),this.renderer.setSize(Math.max(1,e.width),Math.max(1,e.height),!1),this.camera.aspect=Math.max(1,e.width)/Math.max(1,e.height),this.camera.updateProjectionMatrix(),this.invalidate()}};var yh=class{constructor(e){this.looks=e;let t=e.value,i=X("div",{class:"layer-grid",role:"group","aria-label":"Layer"});bs.forEach(([u,d,f],g)=>{let v=X("button",{type:"button",title:`${f} (${g+1})`,onclick:()=>e.set({layer:u})},d);this.layerButtons.set(u,v),i.append(v)});let s=io("Palette",[[t.palette,t.palette]],t.palette,u=>e.set({palette:u}));this.paletteSelect=s.input;let r=Eg("Unit",md,t.unit,u=>e.set({unit:u}));this.isotherms=X("input",{type:"text",inputMode:"decimal",placeholder:"for example 60 80 100","aria-label":"Isotherms",onchange:()=>this.readIsotherms()});let o=io("Material",[["","none: the same at every angle"]],t.material,u=>this.setMaterial(u));this.materialSelect=o.input;let a=Ys("Emissivity","",t.emissivity,.01,u=>e.set({emissivity:u}),{min:.05,max:1}),c=Ys("Reflected",Jn(t.unit),t.reflected_celsius,1,u=>e.set({reflected_celsius:ys(u,e.value.unit)}));this.interpretation=X("div",{class:"sub"},o.element,a.element,c.element);let l=vr("Object temperatures",t.interpret,u=>e.set({interpret:u})),h=X("div",{class:"toggles"},vr("Shading",t.shading,u=>e.set({shading:u})).element,vr("Cameras",t.showCameras,u=>e.set({showCameras:u})).element,vr("Path",t.showPath,u=>e.set({showPath:u})).element,vr("Next view",t.showNext,u=>e.set({showNext:u})).element,vr("Scan volume",t.showVolume,u=>e.set({showVolume:u})).element);this.element.append(X("h3",{},"Layer"),i,s.element,X("div",{class:"field"},X("span",{},"Unit"),r.element),X("label",{class:"field"},X("span",{},"Isotherms"),this.isotherms),l.element,this.interpretation,X("h3",{},"Drawn"),h),e.onChange((u,d)=>{for(let[f,g]of this.layerButtons)g.setAttribute("aria-pressed",String(f===u.layer));Vt(this.interpretation,u.interpret),d.has("emissivity")&&(a.input.value=String(u.emissivity)),(d.has("unit")||d.has("isotherms"))&&(this.isotherms.value=u.isotherms.map(f=>Number(jn(f,u.unit).toFixed(2))).join(" "),c.input.value=String(Number(jn(u.reflected_celsius,u.unit).toFixed(1))),c.element.querySelector(".unit").textContent=Jn(u.unit))})}looks;element=X("div",{class:"view-panel"});layerButtons=new Map;paletteSelect;materialSelect;isotherms;interpretation;setTables(e,t){this.materials=t;let i=(s,r,o)=>{s.replaceChildren(...r.map(([a,c])=>X("option",{value:a,selected:a===o},c)))};i(this.paletteSelect,e.map(s=>[s,s]),this.looks.value.palette),i(this.materialSelect,[["","none: the same at every angle"],...t.map(({name:s,emissivity:r})=>[s,`${s} (${r.toFixed(2)})`])],this.looks.value.material)}materials=[];setMaterial(e){let t=this.materials.find(i=>i.name===e);this.looks.set(t?{material:e,emissivity:Number(t.emissivity.toFixed(3))}:{material:""})}readIsotherms(){let e=this.isotherms.value.split(/[\s;,]+/).filter(t=>t!=="").map(Number);if(e.some(t=>!Number.isFinite(t))){this.isotherms.setCustomValidity("numbers, separated by spaces"),this.isotherms.reportValidity();return}this.isotherms.setCustomValidity(""),this.looks.set({isotherms:e.slice(0,8).map(t=>ys(t,this.looks.value.unit))})}};var rn=new Xl,ln=new Ol,bp=X("canvas",{class:"scene",tabIndex:0,role:"application","aria-label":"The scanned surface in three dimensions. Arrow keys turn the view, plus and minus zoom, H shows all, F follows the rig."}),Sh=X("main",{class:"stage"},bp),dr=new zl,Mh=new Yl(rn),Zo=new Wl(rn),Eh=new Gl(ln),lx=new yh(rn),cx=X("div",{class:"empty"},X("p",{class:"big"},"No scan yet"),X("p",{},"The surface appears here as soon as the rig sends frames.")),vh,Sp,ux,xp=0,hx=!1,Gr=[],dx=X("div",{class:"panels"}),Mp=X("div",{class:"tabs",role:"tablist","aria-label":"Panels"}),bh=X("aside",{class:"side","aria-label":"Controls"},Mp,dx);function Ah(n,e){let t=n.toLowerCase(),i=X("button",{type:"button",role:"tab",id:`tab-${t}`,"aria-controls":`panel-${t}`,onclick:()=>pl(n)},n),s=X("div",{class:"panel",role:"tabpanel",id:`panel-${t}`,"aria-labelledby":`tab-${t}`,tabIndex:0},e);Gr.push({name:n,content:s,button:i}),Mp.append(i),dx.append(s)}function pl(n){Gr.find(t=>t.name===n)?.button.getAttribute("aria-selected")==="true"&&matchMedia("(max-width: 760px)").matches?bh.classList.toggle("closed"):bh.classList.remove("closed");for(let t of Gr){let i=t.name===n;t.button.setAttribute("aria-selected",String(i)),t.button.tabIndex=i?0:-1,Vt(t.content,i)}}Mp.addEventListener("keydown",n=>{let e=n.key==="ArrowRight"?1:n.key==="ArrowLeft"?-1:0;if(e===0)return;let t=Gr.findIndex(({button:s})=>s===document.activeElement),i=Gr[(t+e+Gr.length)%Gr.length];pl(i.name),i.button.focus(),n.stopPropagation()});var dl=n=>{let e=X("span",{},"–"),t=X("span",{class:"chip status",title:n},X("i",{class:"dot","aria-hidden":"true"}),X("small",{},n),e);return{element:t,set:(i,s)=>{Pt(e,i),t.dataset.tone=s}}},Ki={link:dl("Rig"),tracking:dl("Tracking"),nuc:dl("NUC"),rate:dl("Frames"),disk:dl("Disk")};function fx(n){for(let{element:e}of[Ki.link,Ki.nuc,Ki.rate,Ki.disk])Vt(e,n)}var vp=X("span",{class:"scan-name"},"Isotherm"),px=X("div",{class:"offline",role:"alert",hidden:!0},"No connection to the ground service. Trying again …"),aR=X("header",{class:"top"},X("img",{src:"icon.svg",alt:"",width:32,height:32}),vp,X("div",{class:"chips"},...Object.values(Ki).map(({element:n})=>n)),dr.sound),xh=X("div",{class:"toast",role:"alert",hidden:!0}),ax=0;function lR(n){Pt(xh,n),Vt(xh,!0),clearTimeout(ax),ax=window.setTimeout(()=>Vt(xh,!1),5e3)}var mx=X("button",{type:"button",title:"Follow the rig (F)",onclick:()=>rn.set({follow:!rn.value.follow})},"Follow"),cR=X("div",{class:"nav",role:"group","aria-label":"View"},mx,X("button",{type:"button",title:"Show all (H)",onclick:()=>At.home()},"All"),X("button",{type:"button","aria-label":"Nearer",title:"Nearer (+)",onclick:()=>At.nudge(0,0,.8)},"+"),X("button",{type:"button","aria-label":"Farther",title:"Farther (−)",onclick:()=>At.nudge(0,0,1.25)},"−"));Xs(Sh,cx,dr.element,Mh.element,cR,px);Xs(document.getElementById("app"),aR,Sh,bh);var At=new _h(bp,rn),cs=new Yu(At,ln,rn,(n,e)=>lR(`${n}: ${e}`)),fl=new lh(cs,rn);fl.onOpen=()=>pl("Measure");var Ep=new ch(ln);Sh.append(cs.overlay,cs.labels,cs.readout,cs.hint,xh,Ep.element);Ah("View",lx.element);Ah("Measure",fl.element);Ah("Inputs",Zo.element);Ah("Control",Eh.element);pl("View");matchMedia("(max-width: 760px)").matches&&bh.classList.add("closed");function uR(n){let{min_celsius:e,max_celsius:t}=rn.value,i=5,[s,r]=[Math.floor(n[0]/i)*i,Math.ceil(n[1]/i)*i];return Number.isFinite(e)&&Number.isFinite(t)?[Math.min(e,s),Math.max(t,r)]:[s,r]}var yp;function gx(){let{locked:n,widens:e,min_celsius:t,max_celsius:i}=rn.value,s=[t,i],r=Number.isFinite(t)&&Number.isFinite(i);if(!n||e||!r){let o=At.surface.span();s=o??(r?s:null),o&&n&&At.surface.groups>=8&&(s=uR(o),rn.set({min_celsius:s[0],max_celsius:s[1]})),s&&s[1]-s[0]<.5&&(s=[s[0]-.25,s[1]+.25])}!s||s[0]===yp?.[0]&&s[1]===yp[1]||(yp=s,At.surfaceMaterial.setSpan(s[0],s[1]),Mh.setSpan(s[0],s[1]),At.invalidate())}rn.onChange((n,e)=>{mx.setAttribute("aria-pressed",String(n.follow)),e.has("palette")&&Zo.setColours(_x(n.palette)),["locked","widens","min_celsius","max_celsius"].some(t=>e.has(t))&&gx(),(e.has("layer")||e.has("follow"))&&Ap()});function _x(n){return ux?.palettes.find(({name:e})=>e===n)?.colours}function Ap(){ln.post({case:"view",value:{eye:At.eyeInWorld(),details:rn.value.layer==="uncertainty",images:!0,maxBytesPerS:0}})}ln.held=()=>At.surface.held();ln.onState=n=>{hx=n,Vt(px,!n),n&&Ap()};ln.on("welcome",n=>{ux=n;let e=new uh(n.radiance);At.surfaceMaterial.setTables(n.palettes,e,n.materials),At.surfaceMaterial.apply(rn.value),Mh.setPalettes(n.palettes),lx.setTables(n.palettes.map(({name:t})=>t),n.materials),Zo.setColours(_x(rn.value.palette)),Eh.setRole(n.role),fl.setEditable(n.role===1),fl.setMaterials(n.materials.map(({name:t})=>t)),document.documentElement.dataset.role=n.role===1?"operator":"viewer"});var hR={1:"running",2:"ended",3:"from files"};ln.on("scan",n=>{let e=n.model!==vh?.model;vh=n,At.setScan(n),Mh.setLimits(n.limits),Pt(vp,n.name===""?"Isotherm":n.name),vp.title=[n.folder,hR[n.phase]??""].filter(t=>t!=="").join(" · "),document.title=n.name===""?"Isotherm":`${n.name} · Isotherm`,Vt(cx,n.phase===0),Vt(dr.element,n.phase!==3),Vt(Ki.tracking.element,n.phase!==3),n.phase===3&&fx(!1),e&&(n.phase===3&&rn.set({follow:!1}),xp=0,n.phase===1&&rn.set({widens:!0,min_celsius:NaN,max_celsius:NaN}),dr.clear(n.phase===0?"Waiting for a scan":"The scan begins")),n.phase===2&&dr.end("The scan has ended","Its results are written; the surface stays here until the next scan begins"),Eh.setScan(n)});ln.on("maps",n=>At.surface.setMaps(n));ln.on("group",n=>At.surface.add(n));ln.on("details",n=>At.surface.addDetails(n));ln.on("pose",n=>{At.setPose(n),xp=n.tracking;let e={1:["good","good"],2:["degraded","warn"],3:["lost","bad"]},[t,i]=e[xp]??["waiting",""];Ki.tracking.set(t,i)});ln.on("measurements",n=>{cs.set(n),fl.set(n)});ln.on("playback",n=>{Ep.set(n),fx(!1)});ln.on("path",n=>At.setPath(n));ln.on("guidance",n=>{vh?.phase!==2&&(dr.set(n,Sp),At.setNext(n.done?void 0:n.TWorldDepthNext))});ln.on("image",n=>Zo.setImage(n));ln.on("state",n=>{Sp=n,Zo.setState(n,rn.value.unit),Eh.setState(n),dr.update(n);let{link:e,nuc:t,disk:i}=n;Ki.link.set(e?.problem?"trouble":e?.rigPresent?n.scanState||"there":"none",e?.problem?"bad":e?.rigPresent?"good":"bad"),Ki.nuc.set(t?.state??"–",t?.state==="idle"?"good":t?.state?"warn":""),Ki.rate.set(`${(n.depth?.rateHz??0).toFixed(0)} / ${(n.thermal?.rateHz??0).toFixed(0)}`,n.load?.behind?"warn":""),Ki.disk.set(i?.text?i.text.replace(/^disk: /,""):vs(i?.freeBytes),i?.paused?"bad":"")});setInterval(()=>{hx&&Ap(),gx();let n=At.frameTimes,e=n.reduce((t,i)=>t+i,0)/Math.max(1,n.length);Zo.setPage(`${At.surface.triangles.toLocaleString()} triangles, ${At.drawCalls} draw calls, ${e.toFixed(1)} ms a frame, ${vs(ln.takeReceivedBytes())}/s`)},1e3);addEventListener("keydown",n=>{let e=n.target;if(/^(INPUT|SELECT|TEXTAREA)$/.test(e.tagName)||n.ctrlKey||n.metaKey||n.altKey)return;let t=.12,i={ArrowLeft:()=>At.nudge(t,0,1),ArrowRight:()=>At.nudge(-t,0,1),ArrowUp:()=>At.nudge(0,t,1),ArrowDown:()=>At.nudge(0,-t,1),"+":()=>At.nudge(0,0,.85),"=":()=>At.nudge(0,0,.85),"-":()=>At.nudge(0,0,1.18),f:()=>rn.set({follow:!rn.value.follow}),h:()=>At.home(),s:()=>dr.toggleSound()," ":()=>Ep.toggle(),Enter:()=>cs.touchMiddle(),Escape:()=>{cs.setTool("read"),cs.closeReadout()}};if((n.key==="Enter"||n.key===" ")&&e!==bp&&e!==document.body)return;let s=Number(n.key);if(s>=1&&s<=bs.length)rn.set({layer:bs[s-1][0]});else if(i[n.key])i[n.key]();else return;n.preventDefault()});async function yx(){try{await navigator.wakeLock.request("screen")}catch{}}document.addEventListener("visibilitychange",()=>{document.visibilityState==="visible"&&yx()});yx();Cg(Sh).then(()=>ln.open());Object.assign(window,{isotherm:{view:At,looks:rn,connection:ln,measure:cs,get scan(){return vh},get state(){return Sp},openTab:pl}});
