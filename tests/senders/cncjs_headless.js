// CNCjs's own server, driven by its socket API against a virtual controller.
//
// usage: NODE_PATH=FOLDER/node_modules node cncjs_headless.js PORT SERVER_PORT SECRET
// where FOLDER has `npm i cncjs`. Each step prints one line of JSON; the exit status is 0 where every
// step ended as it should. docs/sending.md says how it is run.
'use strict';
const jwt = require('jsonwebtoken');
const io = require('socket.io-client');

const [port, serverPort, secret] = process.argv.slice(2);
const token = jwt.sign({id: '', name: 'headless'}, secret, {expiresIn: '1h'});
const socket = io.connect('http://127.0.0.1:' + serverPort, {query: 'token=' + token});
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

let state = '';
let position = {};
let workflow = '';
let settings = {};
let overrides = [];
let sender = {};
const heard = [];
socket.on('serialport:read', (line) => heard.push(line));
socket.on('controller:settings', (_type, value) => { settings = value.settings || {}; });
socket.on('controller:state', (_type, value) => {
    state = value.status.activeState;
    position = value.status.mpos;
    overrides = value.status.ov || overrides;
});
socket.on('workflow:state', (value) => { workflow = value; });
socket.on('sender:status', (value) => { sender = value; });

async function until(what, condition, seconds) {
    const end = Date.now() + 1000 * seconds;
    while (!condition()) {
        if (Date.now() > end) {
            throw new Error(`${what}: not within ${seconds} s (state ${state}, workflow ${workflow}, `
                + `at ${JSON.stringify(position)}, heard ${JSON.stringify(heard.slice(-6))})`);
        }
        await sleep(20);
    }
}
const command = (...words) => socket.emit('command', port, ...words);
const idle = (seconds = 30) => until('Idle', () => state === 'Idle', seconds);
const at = (axis, value) => Math.abs(Number(position[axis]) - value) < 0.0015;

function load(name, text) {
    return new Promise((done, fail) => command('gcode:load', name, text, {},
        (error) => error ? fail(error) : done()));
}
async function run(name, text, seconds) {
    await load(name, text);
    command('gcode:start');
    await until(name + ' runs', () => workflow === 'running', 5);
    await until(name + ' ends', () => workflow === 'idle' && state === 'Idle', seconds);
}
function zigzag(lines) {
    let text = 'G21 G90 G17\n(a comment)\nG0 Z1\n\n';
    for (let i = 0; i < lines; ++i) {
        text += `G1 X${(i % 11) * 0.7} Y${(i % 5) * 0.9} F6000\n`;
    }
    return text + 'G0 X3 Y4\nM30\n';
}

const steps = {
    async open() {
        await new Promise((done, fail) => socket.emit('open', port,
            {controllerType: 'Grbl', baudrate: 115200}, (error) => error ? fail(error) : done()));
        await until('settings', () => settings['$110'] !== undefined, 8);
        await idle();
    },
    async program() {
        await run('zigzag', zigzag(400), 120);
        if (!at('x', 3) || !at('y', 4)) { throw new Error('ends elsewhere'); }
    },
    async hold_and_resume() {
        await load('long', 'G90 G21\nG1 X40 F1200\nG1 X3 F6000\nM30\n');
        command('gcode:start');
        await until('Run', () => state === 'Run', 5);
        await sleep(400);
        command('gcode:pause');
        await until('Hold', () => state === 'Hold', 5);
        const stands = position.x;
        await sleep(700);
        if (position.x !== stands) { throw new Error('moves while held'); }
        command('gcode:resume');
        await until('end', () => workflow === 'idle' && state === 'Idle' && at('x', 3), 30);
    },
    async overrides() {
        command('feedOverride', 10);
        command('feedOverride', 1);
        command('rapidOverride', 50);
        command('spindleOverride', -10);
        await until('overrides', () => String(overrides) === '111,50,90', 5);
        command('feedOverride', 0);
        command('rapidOverride', 100);
        command('spindleOverride', 0);
        await until('overrides back', () => String(overrides) === '100,100,100', 5);
    },
    async jog_and_cancel() {
        command('gcode', '$J=G91 G21 X40 F1000');
        await until('Jog', () => state === 'Jog', 5);
        await sleep(500);
        command('jogCancel');
        await idle(5);
        if (Number(position.x) > 30) { throw new Error('the jog was not cancelled'); }
        command('gcode', 'G0 X3');
        await until('back', () => state === 'Idle' && at('x', 3), 10);
    },
    async bad_line() {
        await load('bad', 'G90 G21\nG1 X4 F3000\nG1 X5 Q7 B2\nG1 X6\nM30\n');
        command('gcode:start');
        await until('pause at the error', () => workflow === 'paused', 10);
        await until('the error', () => heard.some((line) => /^error:/.test(line)), 5);
        command('gcode:stop', {force: true});
        await sleep(1500);
        await idle(5);
    },
    async stop_in_motion() {
        await load('long', 'G90 G21\nG1 X60 F2000\nG1 X3 F6000\nM30\n');
        command('gcode:start');
        await until('Run', () => state === 'Run', 5);
        await sleep(300);
        command('gcode:stop', {force: true});
        await until('at rest', () => state === 'Idle', 8);
    },
    async reset_in_motion() {
        command('gcode', 'G90 G1 X70 F2000');
        await until('Run', () => state === 'Run', 5);
        await sleep(300);
        command('reset');
        await until('Alarm', () => state === 'Alarm', 5);
        await until('ALARM:3', () => heard.some((line) => /ALARM:3/.test(line)), 5);
        command('unlock');
        await idle(5);
    },
    async homing() {
        command('gcode', ['$22=1', '$25=6000', '$24=600']);
        await sleep(500);
        command('homing');
        await until('Home', () => state === 'Home', 5);
        await until('homed', () => state === 'Idle' && at('x', -1) && at('y', -1) && at('z', -1), 60);
    },
    async check_mode() {
        command('gcode', '$C');
        await until('Check', () => state === 'Check', 5);
        const stands = position.x;
        await load('checked', 'G91 G21\nG1 X-5 F1000\nG1 X-5\nM30\n');
        command('gcode:start');
        await sleep(3000);
        command('gcode:stop');
        if (position.x !== stands) { throw new Error('check mode moves'); }
        command('gcode', '$C');
        await until('out of Check', () => state !== 'Check', 5);
        command('unlock');
        await idle(5);
    },
    async sleep() {
        command('sleep');
        await until('Sleep', () => state === 'Sleep', 5);
        command('reset');
        await until('Alarm', () => state === 'Alarm', 5);
        command('unlock');
        await idle(5);
    },
    async close() {
        await new Promise((done) => socket.emit('close', port, done));
    },
};

async function main() {
    let failed = 0;
    for (const [name, step] of Object.entries(steps)) {
        const start = Date.now();
        let fault = '';
        try {
            await step();
        } catch (error) {
            fault = String(error && error.message || error);
            failed += 1;
        }
        console.log(JSON.stringify({step: name, seconds: (Date.now() - start) / 1000, fault}));
    }
    process.exit(failed === 0 ? 0 : 1);
}
socket.on('connect', main);
socket.on('error', (error) => { console.log(JSON.stringify({fault: String(error)})); process.exit(2); });
setTimeout(() => process.exit(3), 400000);
