/* How a timer in mode 1 is restarted by its interrupt handler. */
#ifndef TIMER_H
#define TIMER_H

/* The counter is written where the macro stands, while it runs: what it has counted since the
   overflow is lost, and every interval is longer by that. */
#define RESTART_WRITE 0
/* Stop, add the reload to what has been counted since the overflow, start: the next overflow comes
   exactly one interval after the last, however late the handler runs. */
#define RESTART_ADD 1

/* Cycles in which the counter stands still in TIMER_ADD, to be added to the reload: from the end of
   `clr` to the end of `setb`. In assembly, so that no compiler changes their number. */
#define TIMER_STOPPED 7

#define TIMER_ADD(n, reload) \
    __asm__("clr _TR" #n "\n" \
            "mov a,_TL" #n "\n" \
            "add a,_" #reload "\n" \
            "mov _TL" #n ",a\n" \
            "mov a,_TH" #n "\n" \
            "addc a,(_" #reload " + 1)\n" \
            "mov _TH" #n ",a\n" \
            "setb _TR" #n "\n")

#define TIMER_WRITE(n, reload) \
    __asm__("mov _TL" #n ",_" #reload "\n" \
            "mov _TH" #n ",(_" #reload " + 1)\n")

#endif
