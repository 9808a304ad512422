/*
 * Plays segments from the serial port on one stepper: step on pin 9 (Mega: 11), direction on pin 8.
 *
 * For each segment that it has taken it answers '+'. A sender that never has more than 60 bytes
 * unanswered loses none. '!' says that bytes came that are no segment, '-' that a step came late.
 */
#include <SegmentAxis.h>

const uint16_t SILENCE_MS = 20;

SegmentAxis axis;
uint16_t late = 0;
uint32_t last_byte_ms = 0;

ISR(TIMER1_COMPA_vect) { axis.on_compare(); }

void setup()
{
    Serial.begin(115200);
    axis.begin(8);
}

void loop()
{
    if (Serial.available() && axis.is_ready()) {
        last_byte_ms = millis();
        if (axis.write(Serial.read()))
            Serial.write('+');
        else if (axis.has_failed())
            Serial.write('!');
    }
    if (millis() - last_byte_ms > SILENCE_MS)
        axis.start();
    if (late != axis.late_steps()) {
        late = axis.late_steps();
        Serial.write('-');
    }
}
