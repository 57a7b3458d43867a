/* --open. */
#ifndef WH_APP_LIVE_BROWSER_H
#define WH_APP_LIVE_BROWSER_H

/* Asks the desktop to show http://PLACE in the person's browser, without waiting for it. If there is none,
 * standard error says so, by `speaker`. */
void wh_live_browse(const char *speaker, const char *place);

#endif
