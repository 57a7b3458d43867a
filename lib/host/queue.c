#include "queue.h"

#include <stdlib.h>

#include <lauxlib.h>

#include "../text/array.h"

wh_controller_t *wh_controller_acting(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    for (size_t i = 0; i < host->count; ++i) {
        wh_controller_t *other = host->controllers[i];
        if (other->leader == controller->leader && other->action.is_there) {
            return other;
        }
    }
    return NULL;
}

wh_pending_t *wh_queue_append(wh_controller_t *from, wh_request_t *request, const wh_lines_t *lines) {
    wh_pending_t *pending = wh_array_new(1, sizeof *pending);
    wh_pending_t **end = &from->leader->pending;
    while (*end) {
        end = &(*end)->next;
    }
    *end = pending;
    pending->from = from;
    pending->request = *request;
    *request = (wh_request_t){.reference = LUA_NOREF};
    if (lines) {
        pending->lines = *lines;
    }
    return pending;
}

int wh_queue_actions(const wh_controller_t *controller) {
    int count = 0;
    for (const wh_pending_t *at = controller->leader->pending; at; at = at->next) {
        count += at->request.command->kind == WH_WORD_ACTION ? 1 : 0;
    }
    return count;
}

wh_pending_t *wh_queue_take(wh_controller_t *controller) {
    wh_pending_t *first = controller->leader->pending;
    if (first) {
        controller->leader->pending = first->next;
        first->next = NULL;
    }
    return first;
}

void wh_queue_free(wh_pending_t *pending) {
    wh_dialect_forget(pending->from->dialect, &pending->request);
    free(pending);
}

void wh_queue_drop_client(wh_controller_t *from) {
    for (wh_pending_t **at = &from->leader->pending; *at;) {
        wh_pending_t *pending = *at;
        if (pending->from == from) {
            *at = pending->next;
            wh_queue_free(pending);
        } else {
            at = &pending->next;
        }
    }
}

bool wh_controller_owes(const wh_controller_t *controller) {
    const wh_action_t *action = &controller->action;
    bool owes = action->is_there && !action->is_answered && !action->is_left;
    for (const wh_pending_t *at = controller->leader->pending; at && !owes; at = at->next) {
        owes = at->from == controller && !at->is_answered;
    }
    return owes;
}
