// Shared frames: how a program in C draws on a display that another program, such as `xorvox share`, drives. This
// header is all it takes: C11 or C++20, Linux, nothing to link. Programs in other languages: docs/share.md has the same
// bytes as tables.
//
//     xorvox_frames frames;
//     int status = xorvox_frames_connect(&frames, "/tmp/display");
//     if (status != XORVOX_FRAMES_OK) return complain(xorvox_frames_text(status));
//     while (status == XORVOX_FRAMES_OK) {
//         draw into xorvox_frames_page(&frames, 0), frames.segment->frame_bytes long
//         status = xorvox_frames_publish(&frames, 0, 0);
//     }
//     xorvox_frames_close(&frames);
//
// The server makes a segment of memory for each program that connects, and passes it over the socket: a header, which
// tells of the display all that drawing needs, and pages, each with room for a frame. What is in a frame, and which
// pixel is where: driver/display/description.h. A page is zeros at first, and keeps what was drawn into it.
//
//     0           header_bytes           + page_stride_bytes        …                     segment_bytes
//     ├─ header ──┼─ page 0 ─ padding ───┼─ page 1 ─ padding ───────┼─ page 2 ─ padding ──┤    pages begin at multiples
//     │ 384 bytes, then zeros             frame_bytes, then zeros                                of 4096 bytes
//
// Two ways to publish a page; a connection keeps to one of them:
//
//  * By message: xorvox_frames_publish() sends one, the server checks it, copies the page and replies. Then the page is
//    the writer's again. One page is enough for that; the others may hold frames that are shown again and again.
//
//  * By atomics: xorvox_frames_begin() gives a page that the server does not read, xorvox_frames_end() makes it the
//    latest one; neither waits, nor calls the system. The server looks once a cycle of the display, at least 20 times a
//    second, and copies the latest page; who is faster than that is not told which frames were seen. The words and
//    their rules are those of driver/host/page_exchange.h.
//
// Whoever writes into a page between publishing it and the reply, or after xorvox_frames_end(), may see a mixture of
// two frames on the display, of its own frames only. The server cannot tell a torn page from one that was meant so, and
// a count of writes beside the page would be kept by the same program that breaks the rule; so there is none.
//
// The server trusts nothing in the segment: it checks each message against the display as it knows it, and reads of the
// segment nothing but pages, tags and the words of the exchange, of which any value is harmless. A program that ends,
// however it ends, leaves its last whole frame on the display. One program draws at a time; another one that connects
// is refused with XORVOX_FRAMES_BUSY, unless the first has published nothing for five seconds: then it takes over.
//
// Numbers are in the byte order of the machine, which both ends run on. One thread at a time may use a xorvox_frames.
#pragma once

#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#ifdef __cplusplus
#include <atomic>
typedef std::atomic<uint32_t> xorvox_frames_word;
#define XORVOX_FRAMES_STD(name) std::name
#define XORVOX_FRAMES_ASSERT(...) static_assert(__VA_ARGS__)
#else
#include <assert.h>
#include <stdatomic.h>
typedef _Atomic uint32_t xorvox_frames_word;
#define XORVOX_FRAMES_STD(name) name
#define XORVOX_FRAMES_ASSERT(...) _Static_assert(__VA_ARGS__, "both ends agree on it")
#endif

#define XORVOX_FRAMES_MAGIC "XVFRAMES" /* 8 bytes, without the 0 at its end */
#define XORVOX_FRAMES_VERSION 1u
#define XORVOX_FRAMES_MAX_PAGES 8u
#define XORVOX_FRAMES_MAX_PANELS 8u
#define XORVOX_FRAMES_PUBLISH 1u              /* xorvox_frames_request.what */
#define XORVOX_FRAMES_PAGE_BITS 4u            /* of an exchanged word: the page; the others count */
#define XORVOX_FRAMES_NO_PAGE 15u             /* no page, in these bits */
#define XORVOX_FRAMES_PATIENCE_NS 5000000000u /* silence after which another program may take over */

/* How the server replies, and what the functions below return. They may also return the negative of an error number of
   the system, such as -ENOENT; after any result but those marked "goes on", the connection is of no more use: close. */
enum xorvox_frames_status {
    XORVOX_FRAMES_OK = 0,             /* The frame is taken, or the connection made. */
    XORVOX_FRAMES_BUSY = 1,           /* Another program is drawing. */
    XORVOX_FRAMES_NO_MEMORY = 2,      /* The server has no memory or no descriptor for a segment. */
    XORVOX_FRAMES_WRONG_MESSAGE = 3,  /* Of another size, without the magic, or of an unknown kind. */
    XORVOX_FRAMES_WRONG_VERSION = 4,  /* Of another version of this protocol. */
    XORVOX_FRAMES_WRONG_PAGE = 5,     /* There is no page of this number. Goes on. */
    XORVOX_FRAMES_WRONG_FORMAT = 6,   /* Not the display's pixel format. Goes on. */
    XORVOX_FRAMES_WRONG_SIZE = 7,     /* Not the bytes of the display's frames. Goes on. */
    XORVOX_FRAMES_WRONG_GEOMETRY = 8, /* Not the digest of the display. Goes on. */
    XORVOX_FRAMES_CLOSED = 9,         /* The server has ended, or another program took over. Never sent. */
    XORVOX_FRAMES_NO_SERVER = 10,     /* What answers there speaks another protocol. Never sent. */
    XORVOX_FRAMES_STATUSES = 11       /* How many there are. */
};

/* One flat panel, in each slice of a frame. */
typedef struct xorvox_frames_panel {
    uint32_t columns;      /*  0 */
    uint32_t rows;         /*  4 */
    uint32_t row_bytes;    /*  8  A row begins at a byte. */
    uint32_t offset_bytes; /* 12  Of its first row in a slice. */
} xorvox_frames_panel;

/* The head of a segment. The server writes it once, and afterwards `released` and the count in `latest`, through which
   the two ends exchange pages. A program writes `tag` and `latest` alone, by xorvox_frames_end(). */
typedef struct xorvox_frames_segment {
    uint8_t magic[8];           /*   0  XORVOX_FRAMES_MAGIC */
    uint32_t version;           /*   8 */
    uint32_t header_bytes;      /*  12  Where page 0 begins. */
    uint64_t segment_bytes;     /*  16 */
    uint64_t frame_bytes;       /*  24  slices * slice_bytes */
    uint64_t page_stride_bytes; /*  32  From a page to the next. */
    uint64_t geometry_digest;   /*  40  As `xorvox displays NAME --json` tells it: equal ones mean equal places. */
    uint32_t pages;             /*  48 */
    uint32_t pixel_format;      /*  52  1 mono1, 2 rgb111, 3 rgb332, 4 rgb565, 5 rgb888, 6 rgb555, 7 mono2, 8 mono4 */
    uint32_t bits_per_pixel;    /*  56 */
    uint32_t display_kind;      /*  60  1 stacked planes, 2 rotating panel, 3 swept plane, 4 helix, 5 free points */
    uint32_t slices;            /*  64 */
    uint32_t panel_count;       /*  68 */
    uint64_t slice_bytes;       /*  72 */
    uint64_t cycle_ns;          /*  80  The display shows a frame so often; more of them are not seen. */
    char display_name[32];      /*  88  UTF-8, ends with a 0. */
    uint32_t unused[2];         /* 120 */
    xorvox_frames_panel panel[XORVOX_FRAMES_MAX_PANELS]; /* 128  The first panel_count are there. */
    uint64_t tag[XORVOX_FRAMES_MAX_PAGES];               /* 256  Of each page, when published by atomics. */
    xorvox_frames_word latest;                           /* 320  The page published last, and how often it was taken. */
    xorvox_frames_word released[XORVOX_FRAMES_MAX_PAGES]; /* 324  How often the server let go of each page. */
    uint32_t unused_too[7];                               /* 356 */
} xorvox_frames_segment;

/* What the server says first, with the segment's descriptor if the status is Ok. */
typedef struct xorvox_frames_hello {
    uint8_t magic[8];         /*  0 */
    uint32_t version;         /*  8 */
    uint32_t status;          /* 12  Ok, Busy or NoMemory; the last two end the connection. */
    uint64_t segment_bytes;   /* 16 */
    uint64_t frame_bytes;     /* 24 */
    uint64_t geometry_digest; /* 32 */
    uint32_t pages;           /* 40 */
    uint32_t pixel_format;    /* 44 */
} xorvox_frames_hello;

/* What the writer says: a page is whole. */
typedef struct xorvox_frames_request {
    uint8_t magic[8];         /*  0 */
    uint32_t version;         /*  8 */
    uint32_t what;            /* 12  XORVOX_FRAMES_PUBLISH */
    uint64_t frame_bytes;     /* 16 */
    uint64_t geometry_digest; /* 24 */
    uint32_t page;            /* 32 */
    uint32_t pixel_format;    /* 36 */
    uint64_t tag;             /* 40 */
} xorvox_frames_request;

/* What the server replies to each request. */
typedef struct xorvox_frames_reply {
    uint8_t magic[8];  /*  0 */
    uint32_t version;  /*  8 */
    uint32_t status;   /* 12 */
    uint32_t page;     /* 16  Of the request; XORVOX_FRAMES_NO_PAGE where it was not understood. */
    uint32_t sequence; /* 20  The how-manieth frame it is, from 1, modulo 2^32, of all that the server took; else 0. */
} xorvox_frames_reply;

XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_word) == 4);
XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_panel) == 16);
XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_segment) == 384);
XORVOX_FRAMES_ASSERT(offsetof(xorvox_frames_segment, panel) == 128);
XORVOX_FRAMES_ASSERT(offsetof(xorvox_frames_segment, tag) == 256);
XORVOX_FRAMES_ASSERT(offsetof(xorvox_frames_segment, latest) == 320);
XORVOX_FRAMES_ASSERT(offsetof(xorvox_frames_segment, released) == 324);
XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_hello) == 48);
XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_request) == 48);
XORVOX_FRAMES_ASSERT(sizeof(xorvox_frames_reply) == 24);

/* A connection. `segment` is the program's to read, and void after close; the rest is the functions'. */
typedef struct xorvox_frames {
    xorvox_frames_segment* segment;
    xorvox_frames_hello hello;
    int socket;
    uint32_t latest;                         /* As in PageWriter of driver/host/page_exchange.h. */
    uint32_t taken[XORVOX_FRAMES_MAX_PAGES]; /* As there. */
} xorvox_frames;

/* What a result of the functions below means, in English. Of an error of the system as strerror(). */
static inline const char* xorvox_frames_text(int status) {
    switch (status) {
        case XORVOX_FRAMES_OK: return "ok";
        case XORVOX_FRAMES_BUSY: return "another program is drawing on this display; end it first";
        case XORVOX_FRAMES_NO_MEMORY: return "the server has no memory for another program's frames";
        case XORVOX_FRAMES_WRONG_MESSAGE: return "the server did not understand the message";
        case XORVOX_FRAMES_WRONG_VERSION: return "the server speaks another version of the protocol";
        case XORVOX_FRAMES_WRONG_PAGE: return "the segment has no page of this number";
        case XORVOX_FRAMES_WRONG_FORMAT: return "the frame's pixel format is not the display's";
        case XORVOX_FRAMES_WRONG_SIZE: return "the frame's size is not that of the display's frames";
        case XORVOX_FRAMES_WRONG_GEOMETRY: return "the frame was drawn for a display of another geometry";
        case XORVOX_FRAMES_CLOSED: return "the server has ended, or another program draws now";
        case XORVOX_FRAMES_NO_SERVER: return "what listens there does not share frames, or in another version";
        default: return status < 0 ? strerror(-status) : "unknown status";
    }
}

/* Ends a connection that xorvox_frames_connect() made, or could not make. What was published stays on the display. */
static inline void xorvox_frames_close(xorvox_frames* frames) {
    if (frames->segment != NULL) munmap((void*)frames->segment, (size_t)frames->hello.segment_bytes);
    if (frames->socket >= 0) close(frames->socket);
    frames->segment = NULL;
    frames->socket = -1;
}

/* For xorvox_frames_connect(): the server's first message, and with it the segment's descriptor, or -1. */
static inline int xorvox_frames_receive_hello(int server, xorvox_frames_hello* hello, int* memory) {
    union {
        struct cmsghdr align;
        unsigned char bytes[CMSG_SPACE(sizeof(int))];
    } control;
    struct iovec part;
    struct msghdr message;
    struct cmsghdr* passed;
    ssize_t size;
    *memory = -1;
    part.iov_base = hello;
    part.iov_len = sizeof *hello;
    memset(&message, 0, sizeof message);
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.bytes;
    message.msg_controllen = sizeof control.bytes;
    do size = recvmsg(server, &message, MSG_CMSG_CLOEXEC);
    while (size < 0 && errno == EINTR);
    if (size < 0) return -errno;
    passed = CMSG_FIRSTHDR(&message);
    if (passed != NULL && passed->cmsg_level == SOL_SOCKET && passed->cmsg_type == SCM_RIGHTS &&
        passed->cmsg_len == CMSG_LEN(sizeof(int))) {
        memcpy(memory, CMSG_DATA(passed), sizeof *memory);
    }
    if (size == 0) return XORVOX_FRAMES_CLOSED;
    if (size != (ssize_t)sizeof *hello || (message.msg_flags & MSG_TRUNC) != 0) return XORVOX_FRAMES_NO_SERVER;
    if (memcmp(hello->magic, XORVOX_FRAMES_MAGIC, 8) != 0) return XORVOX_FRAMES_NO_SERVER;
    if (hello->version != XORVOX_FRAMES_VERSION) return XORVOX_FRAMES_WRONG_VERSION;
    if (hello->status != XORVOX_FRAMES_OK) return (int)hello->status;
    return *memory < 0 ? XORVOX_FRAMES_NO_SERVER : XORVOX_FRAMES_OK;
}

/* For xorvox_frames_connect(): maps the segment, if it is as the server says. */
static inline int xorvox_frames_map(xorvox_frames* frames, int memory) {
    const xorvox_frames_segment* segment;
    struct stat file;
    void* mapped;
    if (fstat(memory, &file) != 0) return -errno;
    if (frames->hello.segment_bytes < sizeof(xorvox_frames_segment) || file.st_size < 0 ||
        (uint64_t)file.st_size < frames->hello.segment_bytes) {
        return XORVOX_FRAMES_NO_SERVER;
    }
    mapped = mmap(NULL, (size_t)frames->hello.segment_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
    if (mapped == MAP_FAILED) return -errno;
    frames->segment = (xorvox_frames_segment*)mapped;
    segment = frames->segment;
    if (memcmp(segment->magic, XORVOX_FRAMES_MAGIC, 8) != 0 || segment->version != XORVOX_FRAMES_VERSION ||
        segment->segment_bytes != frames->hello.segment_bytes || segment->frame_bytes != frames->hello.frame_bytes ||
        segment->pages != frames->hello.pages || segment->pages < 1 || segment->pages > XORVOX_FRAMES_MAX_PAGES ||
        segment->panel_count < 1 || segment->panel_count > XORVOX_FRAMES_MAX_PANELS ||
        segment->header_bytes < sizeof(xorvox_frames_segment) || segment->header_bytes > segment->segment_bytes ||
        segment->page_stride_bytes < segment->frame_bytes ||
        segment->page_stride_bytes > (segment->segment_bytes - segment->header_bytes) / segment->pages) {
        return XORVOX_FRAMES_NO_SERVER;
    }
    return XORVOX_FRAMES_OK;
}

/* Connects to the server whose socket is `path`, and waits for its answer; `frames` is overwritten. Ok; Busy, NoMemory,
   WrongVersion, Closed, NoServer; -ENOENT: there is no such path, -ECONNREFUSED: its server is gone, -EACCES: it is
   another user's, -ENAMETOOLONG: 108 bytes or more. Anything but Ok leaves nothing to close. */
static inline int xorvox_frames_connect(xorvox_frames* frames, const char* path) {
    struct sockaddr_un address;
    int memory = -1;
    int status;
    memset(frames, 0, sizeof *frames);
    frames->socket = -1;
    frames->latest = XORVOX_FRAMES_NO_PAGE;
    memset(&address, 0, sizeof address);
    address.sun_family = AF_UNIX;
    if (strlen(path) >= sizeof address.sun_path) return -ENAMETOOLONG;
    memcpy(address.sun_path, path, strlen(path));
    frames->socket = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (frames->socket < 0) return -errno;
    if (connect(frames->socket, (const struct sockaddr*)&address, sizeof address) != 0) {
        status = errno == EPROTOTYPE ? (int)XORVOX_FRAMES_NO_SERVER : -errno;
    } else {
        status = xorvox_frames_receive_hello(frames->socket, &frames->hello, &memory);
    }
    if (status == XORVOX_FRAMES_OK) status = xorvox_frames_map(frames, memory);
    if (memory >= 0) close(memory); /* The mapping stays. */
    if (status != XORVOX_FRAMES_OK) xorvox_frames_close(frames);
    return status;
}

/* Page `page`, below segment->pages: segment->frame_bytes to draw into. */
static inline uint8_t* xorvox_frames_page(const xorvox_frames* frames, uint32_t page) {
    return (uint8_t*)frames->segment + frames->segment->header_bytes + page * frames->segment->page_stride_bytes;
}

/* Sets a pixel of page `page` to `code`, of bits_per_pixel bits as driver/display/description.h draws them. All numbers
   count from 0 and are below those of the segment. */
static inline void xorvox_frames_put(const xorvox_frames* frames, uint32_t page, uint32_t slice, uint32_t panel,
                                     uint32_t row, uint32_t column, uint32_t code) {
    const xorvox_frames_segment* const s = frames->segment;
    const uint64_t bit = (uint64_t)column * s->bits_per_pixel;
    uint8_t* byte = xorvox_frames_page(frames, page) + slice * s->slice_bytes + s->panel[panel].offset_bytes +
                    (uint64_t)row * s->panel[panel].row_bytes + bit / 8;
    uint32_t mask = ((1u << s->bits_per_pixel) - 1) << bit % 8;
    uint32_t bits = code << bit % 8 & mask;
    for (; mask != 0; ++byte, mask >>= 8, bits >>= 8) *byte = (uint8_t)((*byte & ~mask) | bits);
}

/* The code of a colour in `pixel_format`: the highest bits of each channel, which are 0 to 255; on displays of one
   colour, of the brightness. 0 for a format that is not known. */
static inline uint32_t xorvox_frames_code(uint32_t pixel_format, uint8_t red, uint8_t green, uint8_t blue) {
    const uint32_t r = red, g = green, b = blue;
    const uint32_t brightness = (54 * r + 183 * g + 19 * b) >> 8;
    switch (pixel_format) {
        case 1: return brightness >> 7;
        case 2: return r >> 7 | g >> 7 << 1 | b >> 7 << 2;
        case 3: return r >> 5 << 5 | g >> 5 << 2 | b >> 6;
        case 4: return r >> 3 << 11 | g >> 2 << 5 | b >> 3;
        case 5: return r | g << 8 | b << 16;
        case 6: return r >> 3 << 10 | g >> 3 << 5 | b >> 3;
        case 7: return brightness >> 6;
        case 8: return brightness >> 4;
        default: return 0;
    }
}

/* Publishes `page` by message, and waits for the reply, upon which it may be drawn into again. `tag` is passed on to
   whoever shows the frame. Ok; WrongPage, after which the connection goes on; Closed, NoServer, an error of the system.
   It sends what the server said of the display: a program that brings frames made for a display compares
   segment->geometry_digest with that one's, once. */
static inline int xorvox_frames_publish(xorvox_frames* frames, uint32_t page, uint64_t tag) {
    xorvox_frames_request request;
    xorvox_frames_reply reply;
    ssize_t size;
    memset(&request, 0, sizeof request);
    memcpy(request.magic, XORVOX_FRAMES_MAGIC, 8);
    request.version = XORVOX_FRAMES_VERSION;
    request.what = XORVOX_FRAMES_PUBLISH;
    request.frame_bytes = frames->hello.frame_bytes;
    request.geometry_digest = frames->hello.geometry_digest;
    request.page = page;
    request.pixel_format = frames->hello.pixel_format;
    request.tag = tag;
    do size = send(frames->socket, &request, sizeof request, MSG_NOSIGNAL);
    while (size < 0 && errno == EINTR);
    if (size < 0) return errno == EPIPE || errno == ECONNRESET ? (int)XORVOX_FRAMES_CLOSED : -errno;
    do size = recv(frames->socket, &reply, sizeof reply, 0);
    while (size < 0 && errno == EINTR);
    if (size < 0) return errno == ECONNRESET ? (int)XORVOX_FRAMES_CLOSED : -errno;
    if (size == 0) return XORVOX_FRAMES_CLOSED;
    if (size != (ssize_t)sizeof reply || memcmp(reply.magic, XORVOX_FRAMES_MAGIC, 8) != 0) {
        return XORVOX_FRAMES_NO_SERVER;
    }
    return (int)reply.status;
}

/* Publishing by atomics, first half: a page that the server does not read, to be drawn into until xorvox_frames_end().
   Called again before that, it is the same one. XORVOX_FRAMES_NO_PAGE only with a server that breaks the rules. */
static inline uint32_t xorvox_frames_begin(const xorvox_frames* frames) {
    uint32_t page;
    for (page = 0; page < frames->hello.pages; ++page) {
        uint32_t released;
        if (page == frames->latest) continue;
        released = XORVOX_FRAMES_STD(atomic_load_explicit)(&frames->segment->released[page],
                                                           XORVOX_FRAMES_STD(memory_order_acquire));
        if ((frames->taken[page] - released) << XORVOX_FRAMES_PAGE_BITS == 0) return page;
    }
    return XORVOX_FRAMES_NO_PAGE;
}

/* Second half: `page`, of xorvox_frames_begin(), is whole and may not be touched any more. `tag` goes with it. Nobody
   replies: whether the server is still there, a xorvox_frames_publish() or poll(2) on frames->socket (POLLHUP) tells.
 */
static inline void xorvox_frames_end(xorvox_frames* frames, uint32_t page, uint64_t tag) {
    uint32_t replaced;
    frames->segment->tag[page] = tag;
    replaced = XORVOX_FRAMES_STD(atomic_exchange_explicit)(&frames->segment->latest, page,
                                                           XORVOX_FRAMES_STD(memory_order_acq_rel));
    if (frames->latest != XORVOX_FRAMES_NO_PAGE) frames->taken[frames->latest] += replaced >> XORVOX_FRAMES_PAGE_BITS;
    frames->latest = page;
}

#undef XORVOX_FRAMES_STD
