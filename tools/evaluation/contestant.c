/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/contestant.h"

#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "evaluation/evaluation.h"
#include "reconstruction/chosen_head.h"

static evaluation_contestant *add(evaluation_contestants *chosen, const reconstruction_options *settings,
                                  const char *ablation, const char *label)
{
    evaluation_contestant *it = &chosen->list[chosen->count++];
    *it = (evaluation_contestant){.settings = *settings, .ablation = ablation};
    snprintf(it->label, sizeof it->label, "%s", label);
    return it;
}

void evaluation_contestants_add(evaluation_contestants *chosen, const reconstruction_options *settings,
                                const char *ablation)
{
    (void)add(chosen, settings, ablation, ablation[0] != '\0' ? ablation : settings->method->name);
}

void evaluation_contestants_scene(evaluation_contestants *chosen, const reconstruction_options *settings)
{
    chosen->count = 0;
    (void)add(chosen, settings, "", EVALUATION_SCENE);
}

static int add_head(evaluation_contestants *chosen, const char *text, bool named,
                    const reconstruction_options *settings)
{
    chosen_head head;
    int code = chosen_head_open(&head, text);
    if (code != CLI_OK) {
        return code;
    }
    evaluation_contestant *it = add(chosen, settings, "", named ? head.name : method_trim3r.name);
    it->settings.method = &method_trim3r;
    it->settings.head = text;
    if (named && head.weights != NULL && strcmp(head.bits, "8") != 0) {
        snprintf(it->label, sizeof it->label, "%s_w%ua%u", head.name, head.weight_bits, head.activation_bits);
    }
    chosen_head_close(&head);
    for (const evaluation_contestant *earlier = chosen->list; earlier < it; earlier++) {
        if (earlier->settings.method == &method_trim3r && strcmp(earlier->label, it->label) == 0) {
            return cli_error(CLI_BAD_USAGE, "--heads: %s and %s have the same name and bits (quantize --name)",
                             earlier->settings.head, text);
        }
    }
    return CLI_OK;
}

int evaluation_contestants_add_heads(evaluation_contestants *chosen, char *const *heads, uint32_t head_count,
                                     const reconstruction_options *settings)
{
    int code = head_count == 0 ? add_head(chosen, settings->head, false, settings) : CLI_OK;
    for (uint32_t h = 0; h < head_count && code == CLI_OK; h++) {
        code = add_head(chosen, heads[h], true, settings);
    }
    return code;
}
