/*
 * Runs a sketch on a simulated Uno: segments from standard input to its serial port, never more than
 * 60 bytes unanswered; writes the cycle and the direction of each rising edge of pin 9, then what else
 * than '+' it answered. Needs libsimavr.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <simavr/avr_ioport.h>
#include <simavr/avr_timer.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

enum {
    HZ = 16000000,
    CHARACTER_CYCLES = 10 * HZ / 115200,
    BOOT_CYCLES = HZ / 50,
    WINDOW = 60,
    LONGEST_SEGMENT = 43,
};
/* So long without a step, and with all bytes sent, it is over. */
static const uint64_t QUIET_CYCLES = 4ull * HZ;

static avr_t *avr;
static uint8_t bytes[1 << 20];
static size_t length, sent, answered;
static uint64_t last_event;
static int negative;
static char complaints[16];
static size_t complained;

static void on_direction(struct avr_irq_t *irq, uint32_t value, void *unused)
{
    (void)irq, (void)unused;
    negative = value != 0;
}

static void on_step(struct avr_irq_t *irq, uint32_t value, void *unused)
{
    static uint32_t level;

    (void)irq, (void)unused;
    if (value && !level)
        printf("%" PRIu64 " %c\n", avr->cycle, negative ? '-' : '+');
    level = value;
    last_event = avr->cycle;
}

/* Where the segment at `at` ends: the sender knows what it has made. */
static size_t end_of_segment(size_t at)
{
    unsigned numbers = 1 + (bytes[at] >> 5 & 3);

    at += numbers > 1 ? 3 : 1;
    while (numbers > 0)
        numbers -= bytes[at++] < 0x80;
    return at;
}

static void on_answer(struct avr_irq_t *irq, uint32_t value, void *unused)
{
    (void)irq, (void)unused;
    last_event = avr->cycle;
    if (value == '+' && answered < length)
        answered = end_of_segment(answered);
    else if (complained + 1 < sizeof complaints)
        complaints[complained++] = (char)value;
}

static avr_irq_t *irq_of(uint32_t ioctl, int index)
{
    return avr_io_getirq(avr, ioctl, index);
}

int main(int count, char **arguments)
{
    elf_firmware_t firmware = { 0 };
    uint32_t flags = 0;
    uint64_t next = BOOT_CYCLES;

    if (count != 2 || elf_read_firmware(arguments[1], &firmware))
        return 2;
    avr = avr_make_mcu_by_name("atmega328p");
    avr_init(avr);
    avr->frequency = HZ;
    avr->log = LOG_ERROR;
    avr_load_firmware(avr, &firmware);
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(irq_of(AVR_IOCTL_IOPORT_GETIRQ('B'), 0), on_direction, NULL);
    avr_irq_register_notify(irq_of(AVR_IOCTL_IOPORT_GETIRQ('B'), 1), on_step, NULL);
    avr_irq_register_notify(irq_of(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_answer, NULL);
    length = fread(bytes, 1, sizeof bytes - LONGEST_SEGMENT, stdin);

    while (sent < length || avr->cycle < last_event + QUIET_CYCLES) {
        if (sent < length && sent - answered < WINDOW && avr->cycle >= next) {
            avr_raise_irq(irq_of(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), bytes[sent++]);
            next = avr->cycle + CHARACTER_CYCLES;
        }
        if (complained && complaints[0] == '!')
            break;
        if (avr_run(avr) >= cpu_Done)
            return 3;
    }
    printf("said: %s\n", complaints);
    return 0;
}
