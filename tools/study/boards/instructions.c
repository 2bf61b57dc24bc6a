/* SPDX-License-Identifier: Apache-2.0 */
/* A plugin of QEMU (TCG plugins, API version 1) that counts the instructions between marks, exactly.
 *
 *   -plugin libinstructions.so,mark=head:0x1a2c,mark=refine:0x1a34 -d plugin -D counts.txt
 *
 * A mark is the address of a function: it counts the instructions from its call to the next mark's. At the end a line
 * is written for each mark: its name, its instructions, and the most of them between one of its calls and the next
 * mark. QEMU's header is in no package of Debian, so the used part of the interface is declared here. */
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- QEMU's interface, as its documentation of TCG plugins has it ---- */

typedef uint64_t plugin_id;
struct qemu_plugin_tb;
enum { API_VERSION = 1, NO_REGISTERS = 0, ADD_U64 = 0 };

extern void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id id, void (*translated)(plugin_id, struct qemu_plugin_tb *));
extern void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *block, void (*executed)(unsigned, void *),
                                                 int registers, void *user);
extern void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb *block, int operation, void *counter,
                                                     uint64_t operand);
extern void qemu_plugin_register_atexit_cb(plugin_id id, void (*ended)(plugin_id, void *), void *user);
extern size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
extern uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *block);
extern void qemu_plugin_outs(const char *text);

#define EXPORTED __attribute__((visibility("default")))
EXPORTED extern int qemu_plugin_version;
EXPORTED int qemu_plugin_version = API_VERSION;
EXPORTED int qemu_plugin_install(plugin_id id, const void *info, int count, char **words);

/* ---- counting ---- */

enum { MARKS_MOST = 32, NAME_BYTES = 32 };

typedef struct mark {
    char name[NAME_BYTES];
    uint64_t address;
    uint64_t instructions, longest;
} mark;

static mark marks[MARKS_MOST] = {{"start", 0, 0, 0}}; /* the first: before any other */
static uint32_t mark_count = 1, current;
static uint64_t executed, since; /* the total; the count at which the current mark began */

static void change_to(uint32_t next)
{
    const uint64_t stretch = executed - since;
    marks[current].instructions += stretch;
    marks[current].longest = stretch > marks[current].longest ? stretch : marks[current].longest;
    current = next;
    since = executed;
}

static void at_mark(unsigned processor, void *user)
{
    (void)processor;
    change_to((uint32_t)(uintptr_t)user);
}

/* bit 0 of an address in a symbol table means Thumb */
static void on_block(plugin_id id, struct qemu_plugin_tb *block)
{
    (void)id;
    for (uint32_t i = 1; i < mark_count; i++) {
        if (marks[i].address == qemu_plugin_tb_vaddr(block)) {
            qemu_plugin_register_vcpu_tb_exec_cb(block, at_mark, NO_REGISTERS, (void *)(uintptr_t)i);
        }
    }
    qemu_plugin_register_vcpu_tb_exec_inline(block, ADD_U64, &executed, qemu_plugin_tb_n_insns(block));
}

static void on_end(plugin_id id, void *user)
{
    (void)id, (void)user;
    change_to(current);
    for (uint32_t i = 0; i < mark_count; i++) {
        char line[128];
        snprintf(line, sizeof line, "%.31s %" PRIu64 " %" PRIu64 "\n", marks[i].name, marks[i].instructions,
                 marks[i].longest);
        qemu_plugin_outs(line);
    }
}

int qemu_plugin_install(plugin_id id, const void *info, int count, char **words)
{
    (void)info;
    for (int i = 0; i < count; i++) {
        const char *name = strncmp(words[i], "mark=", 5) == 0 ? words[i] + 5 : NULL;
        const char *colon = name != NULL ? strchr(name, ':') : NULL;
        if (colon == NULL || mark_count == MARKS_MOST || colon - name >= NAME_BYTES) {
            fprintf(stderr, "instructions: %s is not mark=NAME:ADDRESS, or one too many\n", words[i]);
            return -1;
        }
        mark *m = &marks[mark_count++];
        memcpy(m->name, name, (size_t)(colon - name));
        m->address = strtoull(colon + 1, NULL, 0) & ~UINT64_C(1);
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_block);
    qemu_plugin_register_atexit_cb(id, on_end, NULL);
    return 0;
}
